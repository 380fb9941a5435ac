#include "engine/base/csv.hpp"

#include <doctest/doctest.h>

using namespace abbe;

TEST_CASE("lines that a spreadsheet filled up with commas say what they said before") {
  const CsvTable t = read_csv(
      SourceFile("t.csv", "# point: surface,,\n\"# sensor A: tip, long\",,\nfeature,x,y\nB,1,2\n\"#1\",3,4\n,,\n"));
  REQUIRE(t.remarks.size() == 2);
  CHECK(t.remarks[0].value == "surface");
  CHECK(t.remarks[1].key == "sensor A");
  CHECK(t.remarks[1].value == "tip, long");
  REQUIRE(t.rows.size() == 2);
  CHECK(t.rows[1].fields[0].text == "#1");
  // In the table a label of that kind is one, whatever else the row lacks.
  CHECK(read_csv(SourceFile("t.csv", "feature,x\n\"#1\",\n")).rows.size() == 1);
}

TEST_CASE("a quoted field is what its quotes enclose, and nothing may stand beside them") {
  const auto table = [](const std::string& row) { return read_csv(SourceFile("t.csv", "feature,x\n" + row + "\n")); };
  CHECK(table(R"( "a ""b"", c" ,1)").rows.at(0).fields.at(0).text == R"(a "b", c)");
  try {
    table(R"("BORE"X,1)");
    FAIL("text behind a closing quote was read");
  } catch (const UserError& e) {
    REQUIRE(e.diagnostics().size() == 1);
    CHECK(e.diagnostics()[0].code == Code::E0521);
    CHECK(e.diagnostics()[0].place == Place{2, 7});
  }
}
