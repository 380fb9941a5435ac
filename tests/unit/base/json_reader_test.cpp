#include "engine/base/json_reader.hpp"

#include <doctest/doctest.h>

#include <functional>

namespace abbe {

namespace {

using Questions = std::function<void(JsonObject)>;

/// What reading `text` with these questions reports; empty when all is well.
std::vector<Diagnostic> reading(const std::string& text, const Questions& ask) {
  try {
    JsonReader reader(SourceFile("f.json", text));
    ask(reader.root());
    reader.finish();
  } catch (const UserError& error) {
    return error.diagnostics();
  }
  return {};
}

void check_one(const std::vector<Diagnostic>& found, Code code, Place place) {
  REQUIRE(found.size() == 1);
  CHECK(found[0].code == code);
  CHECK(found[0].file == "f.json");
  CHECK(found[0].place.line == place.line);
  CHECK(found[0].place.column == place.column);
  CHECK(!found[0].message.empty());
}

const Questions kNothing = [](JsonObject) {};

}  // namespace

TEST_CASE("values of every type are read") {
  const std::string text =
      R"({"n": -1.5e3, "i": 7, "j": 8.0, "t": "a\"b\\", "f": true, "v": [1, 2, 3], "w": ["p", "q"],
    "o": {"k": 1}, "l": [{"k": 2}, {"k": 3}], "m": [[1, 2], [], [3]]})";
  CHECK(reading(text, [](JsonObject o) {
          CHECK(o.number("n") == -1500);
          CHECK(o.integer_or("i", 0, 1, 9) == 7);
          CHECK(o.integer_or("j", 0, 1, 9) == 8);
          CHECK(o.text("t") == "a\"b\\");
          CHECK(o.flag_or("f", false));
          CHECK(o.numbers_or("v", {}, 3) == std::vector<double>{1, 2, 3});
          CHECK(o.text_list_or("w", {}) == std::vector<std::string>{"p", "q"});
          CHECK(o.object("o").number("k") == 1);
          const std::vector<JsonObject> list = o.object_list("l");
          REQUIRE(list.size() == 2);
          CHECK(JsonObject(list[1]).number("k") == 3);
          CHECK(o.number_lists("m") == std::vector<std::vector<double>>{{1, 2}, {}, {3}});
          CHECK(o.number_or("missing", 4) == 4);
          CHECK(o.text_or("missing", "d") == "d");
          CHECK(!o.object_or_absent("missing").present());
          CHECK(o.object_or_absent("missing").number("k") == 0);
        }).empty());
}

TEST_CASE("an unknown key is named, with its place and the nearest key") {
  const auto found = reading("{\n  \"travel_mm\": 5,\n  \"direktion\": 1\n}", [](JsonObject o) {
    o.number("travel_mm");
    o.integer_or("direction", 1, -1, 1);
  });
  check_one(found, Code::E0402, {3, 3});
  CHECK(found[0].message.find("direktion") != std::string::npos);
  CHECK(found[0].help.find("\"direction\"") != std::string::npos);
  CHECK(found[0].replacement == "\"direction\"");
  CHECK(found[0].caret_length == 11);
}

TEST_CASE("unknown keys are found at any depth, and beside other faults") {
  const auto found = reading(R"({"a": {"b": {"zzz": 1}}, "l": [{"c": 1}, {"d": "x"}], "e": 1})", [](JsonObject o) {
    o.object("a").object("b").number_or("k", 0);
    for (JsonObject item : o.object_list("l")) item.number_or("d", 0);
  });
  REQUIRE(found.size() == 4);
  CHECK(found[0].code == Code::E0402);  // zzz
  CHECK(found[1].code == Code::E0402);  // c
  CHECK(found[2].code == Code::E0405);  // d is a text
  CHECK(found[3].code == Code::E0402);  // e
}

TEST_CASE("what is wrong with a value is said at the value") {
  check_one(reading("{\"a\": \"5\"}", [](JsonObject o) { o.number("a"); }), Code::E0405, {1, 7});
  CHECK(reading("{\"a\": \"5\"}", [](JsonObject o) { o.number("a"); }).at(0).help == "write 5 without the quotes");
  check_one(reading("{\"a\": -5}", [](JsonObject o) { o.number("a", kPositive); }), Code::E0406, {1, 7});
  check_one(reading("{\"a\": 0}", [](JsonObject o) { o.number_or("a", 1, kPositive); }), Code::E0406, {1, 7});
  check_one(reading("{\"a\": 1.5}", [](JsonObject o) { o.integer_or("a", 1, 0, 9); }), Code::E0406, {1, 7});
  check_one(reading("{\"a\": 10}", [](JsonObject o) { o.integer_or("a", 1, 0, 9); }), Code::E0406, {1, 7});
  check_one(reading("{\"a\": [1, 2]}", [](JsonObject o) { o.numbers_or("a", {}, 3); }), Code::E0406, {1, 7});
  check_one(reading("{\"a\": [1, \"x\", 2]}", [](JsonObject o) { o.numbers_or("a", {}, 3); }), Code::E0405, {1, 11});
  check_one(reading("{\"a\": [1, -1]}", [](JsonObject o) { o.number_list("a", kNotNegative); }), Code::E0406, {1, 11});
  check_one(reading("{\"a\": [1]}", [](JsonObject o) { o.object("a"); }), Code::E0405, {1, 7});
  check_one(reading("{\"o\": {}}", [](JsonObject o) { o.object("o").text("k"); }), Code::E0404, {1, 7});
  check_one(reading("{\"a\": \"\"}", [](JsonObject o) { o.text("a"); }), Code::E0406, {1, 7});
  check_one(reading("{\"a\": [[1], 2]}", [](JsonObject o) { o.number_lists("a"); }), Code::E0405, {1, 13});
  const auto word = reading("{\"m\": \"steal\"}", [](JsonObject o) {
    o.one_of("m", o.text("m"), {"steel", "ceramic"});
  });
  check_one(word, Code::E0406, {1, 7});
  CHECK(word[0].help.find("steel") != std::string::npos);
}

TEST_CASE("the range of a number includes what its words say") {
  CHECK(kNotNegative.holds(0));
  CHECK(!kPositive.holds(0));
  CHECK(kPositiveShare.holds(1));
  CHECK(!kPositiveShare.holds(0));
  CHECK(kShare.holds(0));
  CHECK(!kAnyNumber.holds(kInfinity));
}

TEST_CASE("a missing object is one error, not one for each of its keys") {
  check_one(reading("{}", [](JsonObject o) { o.object("axes").object("x").number("travel_mm"); }), Code::E0404, {1, 1});
}

TEST_CASE("a letter in the code of Windows is refused for its code, not for its place") {
  const auto found = reading("{\"name\": \"Gef\xE4\xDF\"}", kNothing);
  check_one(found, Code::E0401, {1, 14});
  CHECK(found[0].help == "save the file as UTF-8");
}

TEST_CASE("a NUL character is refused: what follows it would not be read") {
  check_one(reading(std::string("{}\n \0 {\"a\": 1}", 13), kNothing), Code::E0401, {2, 2});
}

TEST_CASE("a duplicate key names the first") {
  const auto found = reading("{\"a\": 1,\n \"b\": 2,\n \"a\": 3}", kNothing);
  check_one(found, Code::E0403, {3, 2});
  CHECK(found[0].message.find("line 1") != std::string::npos);
}

TEST_CASE("what is not JSON is refused with its place") {
  check_one(reading("{\"a\": 1,}", kNothing), Code::E0401, {1, 9});
  check_one(reading("{\n  // comment\n}", kNothing), Code::E0401, {2, 3});
  check_one(reading("", kNothing), Code::E0401, {1, 1});
  check_one(reading("{\"a\": 1e999}", kNothing), Code::E0406, {1, 11});
  check_one(reading("[1]", kNothing), Code::E0405, {1, 1});
  const auto deep = reading("{\"a\": " + std::string(100'000, '['), kNothing);
  REQUIRE(deep.size() == 1);
  CHECK(deep[0].code == Code::E0401);
}

TEST_CASE("places are right after a byte order mark, CRLF and escapes") {
  check_one(reading("\xEF\xBB\xBF{\r\n\"q\\u0022\\\\\": [ [ ] , [ ] ],\r\n\t\"bad\": null }",
                    [](JsonObject o) { o.number_lists("q\"\\"); }),
            Code::E0402, {3, 2});
}

}  // namespace abbe
