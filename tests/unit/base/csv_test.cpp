#include "engine/base/csv.hpp"

#include <doctest/doctest.h>

using namespace abbe;

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
