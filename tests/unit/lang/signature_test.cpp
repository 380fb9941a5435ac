#include "lang/signature.hpp"

#include <doctest/doctest.h>

#include "engine/base/ids.hpp"

using namespace abbe;
using namespace abbe::lang;

namespace {

std::variant<Match, Mismatch> match_text(std::string_view signature, const std::string& arguments,
                                         const Units& units = {}) {
  const SourceFile source("test.dmi", "X/" + arguments);
  Sink sink;
  const RawStatement raw = *parse_statement(logical_lines(source).at(0), source, sink);
  return match(parse_signature(signature), raw.arguments, units);
}

Match matched(std::string_view signature, const std::string& arguments, const Units& units = {}) {
  auto result = match_text(signature, arguments, units);
  REQUIRE(std::holds_alternative<Match>(result));
  return std::get<Match>(result);
}

Mismatch mismatched(std::string_view signature, const std::string& arguments) {
  auto result = match_text(signature, arguments);
  REQUIRE(std::holds_alternative<Mismatch>(result));
  return std::get<Mismatch>(result);
}

}  // namespace

TEST_CASE("words, choices and values") {
  const Match m =
      matched("side:INNER|OUTER, CART, x:length, n:integer, name:text, from:feature", "outer,cart,2,3,'a',FA(b)");
  CHECK(m.text("side") == "OUTER");
  CHECK(m.number("x") == 2);
  CHECK(m.number("n") == 3);
  CHECK(m.text("name") == "a");
  CHECK(m.find("from")->label.name == "b");
  CHECK_FALSE(m.has("CART"));
  CHECK(m.number("absent", 7) == 7);
}

TEST_CASE("lengths and angles take the units in force, numbers do not") {
  const Units inch_radians{25.4, 1};
  const Match m = matched("x:length, a:angle, n:number", "2,0.5,3", inch_radians);
  CHECK(m.number("x") == 50.8);
  CHECK(m.number("a") == 0.5);
  CHECK(m.number("n") == 3);
  CHECK(matched("a:angle", "-90:30:00").number("a") == doctest::Approx(-90.5 * kDegree).epsilon(1e-15));
}

TEST_CASE("optional items are all or nothing, repeats append, the first alternative wins") {
  CHECK(matched("x:number, [ i:number, j:number ]", "1").values.size() == 1);
  CHECK(matched("x:number, [ i:number, j:number ]", "1,2,3").values.size() == 3);
  CHECK(matched("{ f:feature }, { t:tolerance }", "FA(a),FA(b),TA(c)").values.size() == 3);
  CHECK(matched("( BND, x:number ; UNBND, y:number ; z:number )", "UNBND,4").number("y") == 4);
  CHECK(matched("( BND, x:number ; UNBND, y:number ; z:number )", "4").number("z") == 4);
  CHECK(matched("k:word, ...", "CIRCLE,1,2,3").used == 1);
}

TEST_CASE("a mismatch names the furthest argument and all that could stand there") {
  const Mismatch short_vector = mismatched("x:number, [ i:number, j:number ]", "1,2");
  CHECK(short_vector.argument == 2);
  CHECK(short_vector.expected == std::vector<std::string>{"a number (j)"});
  const Mismatch wrong_word = mismatched("( BND, x:number ; UNBND, y:number )", "BOND,3");
  CHECK(wrong_word.argument == 0);
  CHECK(wrong_word.words == std::vector<std::string>{"BND", "UNBND"});
  const Mismatch surplus = mismatched("x:number", "1,2");
  CHECK(surplus.argument == 1);
  CHECK(surplus.expected.empty());
  CHECK(mismatched("f:feature", "TA(x)").argument == 0);
  CHECK(mismatched("n:integer", "2.5").argument == 0);
}

TEST_CASE("a mismatch says whether all that is needed stands before it") {
  CHECK(mismatched("x:number, [ m:MMC|RFS ]", "1,FA(a)").complete);
  CHECK(mismatched("x:number", "1,2").complete);
  CHECK_FALSE(mismatched("x:number, [ i:number, j:number ]", "1,2").complete);
  CHECK_FALSE(mismatched("x:number, m:MMC|RFS", "1,FA(a)").complete);
}

TEST_CASE("text that is not in the notation is a mistake of ours") {
  for (const char* bad : {"x:lenght", "[ x:number", "x:", "( a:number", "cart", "]"})
    CHECK_THROWS_AS(parse_signature(bad), InternalError);
}
