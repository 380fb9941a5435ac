#include "engine/base/diagnostic.hpp"

#include <doctest/doctest.h>

namespace abbe {

TEST_CASE("places count lines and columns from 1, whatever ends a line") {
  const SourceFile source("f", "ab\ncd\r\nef\rg");
  CHECK(source.line_count() == 4);
  CHECK(source.place(0) == Place{1, 1});
  CHECK(source.place(4) == Place{2, 2});
  CHECK(source.place(7) == Place{3, 1});
  CHECK(source.place(10) == Place{4, 1});
  CHECK(source.line(2) == "cd");
  CHECK(source.line(3) == "ef");
  CHECK(source.text({3, 5}) == "cd");
}

TEST_CASE("a message shows its line, with the caret under the word") {
  const SourceFile source("p.dmi", "one\n\ttwo three\n");
  const Diagnostic d = diagnostic_at(source, {9, 14}, Code::E0406, "three is too many", "take two");
  CHECK(render(d) == "p.dmi:2:6: error E0406: three is too many\n  \ttwo three\n  \t    ^^^^^\n  help: take two\n");
  CHECK(render(diagnostic(Code::W0416, "few")) == "warning W0416: few\n");
}

TEST_CASE("the caret stands under the characters, not under their bytes") {
  const SourceFile source("p", "F(äö)=FÄAT");
  CHECK(render(diagnostic_at(source, {8, 13}, Code::E0110, "x")) ==
        "p:1:9: error E0110: x\n  F(äö)=FÄAT\n        ^^^^\n");
}

TEST_CASE("of a long line what lies about the place is shown") {
  const std::string a(100'000, 'a'), b(100'000, 'b');
  const SourceFile source("p", a + "wrong" + b);
  CHECK(render(diagnostic_at(source, {100'000, 100'005}, Code::E0110, "x")) ==
        "p:1:100001: error E0110: x\n  ..." + a.substr(0, 60) + "wrong" + b.substr(0, 95) + "...\n  " +
            std::string(63, ' ') + "^^^^^\n");
  const std::string whole = render(diagnostic_at(source, {0, 200'005}, Code::E0110, "'" + a + "' is wrong"));
  CHECK(whole.size() < 3'000);
  CHECK(whole.ends_with("\n  " + a.substr(0, 160) + "...\n  " + std::string(160, '^') + "\n"));
  CHECK(render(diagnostic_at(source, {200'004, 200'005}, Code::E0110, "x")) ==
        "p:1:200005: error E0110: x\n  ..." + b.substr(0, 160) + "\n  " + std::string(162, ' ') + "^\n");
}

TEST_CASE("control characters are shown, not sent") {
  const SourceFile source("p", std::string("A\0B\033[2J\x7f", 8));
  CHECK(render(diagnostic_at(source, {2, 3}, Code::E0110, std::string("'\0\033'", 4), "\b")) ==
        "p:1:3: error E0110: '\u2400\u241b'\n  A\u2400B\u241b[2J\u2421\n    ^\n  help: \u2408\n");
}

TEST_CASE("a caret stays on its line") {
  const SourceFile source("p", "ab\ncd");
  CHECK(diagnostic_at(source, {1, 5}, Code::E0401, "x").caret_length == 1);
  CHECK(diagnostic_at(source, {5, 5}, Code::E0401, "x").caret_length == 1);
}

TEST_CASE("a word of a megabyte is near to nothing") {
  const std::string word(1'000'000, 'A'), other(1'000'000, 'B');  // compared letter by letter, this would not end
  for (int k = 0; k < 200; ++k) CHECK(nearest_word(word, {"GOTO", "MEAS", other}).empty());
  CHECK(nearest_word("GOTTO", {"GOTO", "MEAS"}) == "GOTO");
}

TEST_CASE("messages are sorted by place; only errors count as errors") {
  const SourceFile source("p", "abcdef");
  Sink sink;
  sink.add(diagnostic_at(source, {4, 5}, Code::W0416, "later"));
  sink.add(diagnostic_at(source, {1, 2}, Code::W0416, "earlier"));
  CHECK(sink.sorted()[0].message == "earlier");
  CHECK(!sink.has_errors());
  sink.add(diagnostic(Code::E0401, "bad"));
  CHECK(sink.has_errors());
}

TEST_CASE("a slip of the pen is recognised, another word is not") {
  CHECK(nearest_word("PTMAES", {"PTMEAS", "GOTO"}) == "PTMEAS");
  CHECK(nearest_word("goto", {"PTMEAS", "GOTO"}) == "GOTO");
  CHECK(nearest_word("MAES", {"GOTO", "MEAS"}) == "MEAS");  // neighbours exchanged: one slip
  CHECK(nearest_word("XZPLAN", {"XYPLAN", "YZPLAN", "ZXPLAN"}) == "ZXPLAN");
  CHECK(nearest_word("ab", {"xy"}).empty());
  CHECK(nearest_word("travel", {"direction"}).empty());
  CHECK(nearest_word("anything", {}).empty());
}

TEST_CASE("of a name with parts, one that is missing or wrong is recognised") {
  const std::vector<std::string_view> effects = {"probe.pretravel_lobing", "probe.step", "machine.step"};
  CHECK(nearest_name("probe.pretravel_lobbing", effects) == "probe.pretravel_lobing");
  CHECK(nearest_name("pretravel_lobing", effects) == "probe.pretravel_lobing");
  CHECK(nearest_name("head.pretravel_lobbing", effects) == "probe.pretravel_lobing");
  CHECK(nearest_name("lobing", effects) == "probe.pretravel_lobing");
  CHECK(nearest_name("probe.pretravel", effects) == "probe.pretravel_lobing");
  CHECK(nearest_name("step", effects).empty());  // which?
  CHECK(nearest_name("travel", effects).empty());
  CHECK(nearest_name("travel", {"travel_mm", "direction"}) == "travel_mm");
  CHECK(nearest_name("travel_m", {"travel_mm", "direction"}) == "travel_mm");
  CHECK(nearest_name("", {"travel_mm"}).empty());
}

TEST_CASE("every code is listed once, with its letter and a title") {
  for (const CodeInfo& code : all_codes()) {
    CAPTURE(code.name);
    CHECK(info(code.code).name == code.name);
    CHECK(code.name.front() ==
          (code.severity == Severity::error         ? 'E'
               : code.severity == Severity::warning ? 'W'
                                                    : 'N'));
    CHECK(!code.title.empty());
  }
}

}  // namespace abbe
