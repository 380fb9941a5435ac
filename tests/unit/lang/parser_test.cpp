#include "lang/parser.hpp"

#include <doctest/doctest.h>

using namespace abbe;
using namespace abbe::lang;
using Kind = RawArgument::Kind;

namespace {

RawStatement parse(const std::string& text) {
  const SourceFile source("test.dmi", text);
  Sink sink;
  const auto lines = logical_lines(source);
  const auto raw = parse_statement(lines.at(0), source, sink);
  REQUIRE(raw.has_value());
  CHECK(sink.list().empty());
  return *raw;
}

Kind kind_of(const std::string& argument) { return parse("X/" + argument).arguments.at(0).kind; }

}  // namespace

TEST_CASE("label, word and arguments of a statement") {
  const RawStatement raw = parse("  f( Bore 1 ) = Feat / circle , -1.5E-3,, 'it''s', FA(x) ");
  REQUIRE(raw.label.has_value());
  CHECK(raw.label->kind == "F");
  CHECK(raw.label->name == "Bore 1");
  CHECK(raw.word == "FEAT");
  REQUIRE(raw.arguments.size() == 5);
  CHECK(raw.arguments[0].word == "CIRCLE");
  CHECK(raw.arguments[1].number == -1.5e-3);
  CHECK(raw.arguments[2].kind == Kind::empty);
  CHECK(raw.arguments[3].text == "it's");
  CHECK(raw.arguments[4].label.kind == "FA");
  CHECK(raw.arguments[4].label.name == "x");
}

TEST_CASE("numbers as DMIS writes them") {
  for (const auto& [text, value] : std::vector<std::pair<std::string, double>>{
           {"43", 43}, {"+43.000", 43}, {".1", 0.1}, {"1.", 1}, {"-1.5E-3", -1.5e-3}, {"-0", 0}}) {
    const RawArgument a = parse("X/" + text).arguments.at(0);
    CHECK(a.kind == Kind::number);
    CHECK(a.number == value);
  }
}

TEST_CASE("kinds of arguments") {
  CHECK(kind_of("CART") == Kind::word);
  CHECK(kind_of("-ZDIR") == Kind::word);
  CHECK(kind_of("2D") == Kind::word);
  CHECK(kind_of("'a' , 1") == Kind::text);
  CHECK(kind_of("DAT(A)") == Kind::label);
  CHECK(kind_of("1 2") == Kind::several);
  CHECK(kind_of("F(A)4") == Kind::several);
  CHECK(kind_of("'a' 4.0") == Kind::several);
  CHECK(kind_of("0.00 -1.000") == Kind::several);
  CHECK(kind_of("-1 +2") == Kind::several);
  CHECK(kind_of("1 2 -3") == Kind::several);
  CHECK(kind_of("CART 1 -2") == Kind::several);
  CHECK(kind_of("1-2") == Kind::expression);
  CHECK(kind_of("1 - 2") == Kind::expression);
  CHECK(kind_of("1- 2") == Kind::expression);
  CHECK(kind_of("A -1") == Kind::expression);
  CHECK(kind_of("(1 -2)") == Kind::expression);
  CHECK(kind_of("1 -2*A") == Kind::expression);
  CHECK(kind_of("1+2") == Kind::expression);
  CHECK(kind_of("X .LT. 3") == Kind::expression);
  CHECK(kind_of("(1,2)") == Kind::expression);
  CHECK(kind_of("SIN(X)*2") == Kind::expression);
  CHECK(kind_of("12:30:15") == Kind::expression);
  CHECK(kind_of("1.0.5") == Kind::expression);
  CHECK(parse("X/+zdir").arguments.at(0).word == "ZDIR");
  CHECK(parse("X/-zdir").arguments.at(0).word == "-ZDIR");
}

TEST_CASE("commas in parentheses and strings do not separate arguments") {
  const RawStatement raw = parse("X/MX(1,(2,3)),'a,b',4");
  REQUIRE(raw.arguments.size() == 3);
  CHECK(raw.arguments[0].text == "MX(1,(2,3))");
  CHECK(raw.arguments[1].text == "a,b");
}

TEST_CASE("statements without a slash, variables and jump targets") {
  CHECK(parse("ENDMES").arguments.empty());
  CHECK(parse("PRCOMP/").arguments.empty());
  const RawStatement assign = parse("COUNT_1=ASSIGN/COUNT_1+1");
  CHECK(assign.label->kind.empty());
  CHECK(assign.label->name == "COUNT_1");
  CHECK(assign.word == "ASSIGN");
  const RawStatement target = parse(" ( AGAIN ) ");
  REQUIRE(target.target.has_value());
  CHECK(target.target->name == "AGAIN");
}

TEST_CASE("a statement may be cut into thousands of lines") {
  std::string text = "GOTO/1,$\n";
  for (int i = 0; i < 5000; ++i) text += "          $\n";
  const RawStatement raw = parse(text + "2,3");
  REQUIRE(raw.arguments.size() == 3);
  CHECK(raw.arguments[1].number == 2);
}
