#include "engine/recording/value_recording.hpp"

#include <doctest/doctest.h>

#include "engine/base/diagnostic.hpp"
#include "engine/recording/recording.hpp"

namespace abbe {
namespace {

using Labels = std::vector<std::string>;

TEST_CASE("a characteristic is named by its tolerance, or with its features") {
  CHECK(labels_of("len") == Labels{"LEN"});
  CHECK(labels_of("END1 END2 LEN") == Labels{"END1", "END2", "LEN"});
  CHECK(labels_of("FA(END1),FA(END2),TA(LEN)") == Labels{"END1", "END2", "LEN"});
  CHECK(labels_of("F(fa),T(ta)") == Labels{"FA", "TA"});
  CHECK(labels_of("F T") == Labels{"F", "T"});  // short, but no kinds
  CHECK(labels_of(" , ").empty());
  CHECK(labels_of("FA(größe)") == Labels{"GRÖßE"});  // as programs have it: letter_case.hpp
}

TEST_CASE("columns that are left out have their usual values") {
  const SourceFile file("v.csv", "# machine: M\ncharacteristic,value\nLEN,100.001\n");
  CHECK(is_value_recording(file));
  const ValueRecording r = read_value_recording(file);
  REQUIRE(r.rows.size() == 1);
  CHECK(r.rows[0].value == 100.001);
  CHECK_FALSE(r.rows[0].reference);
  CHECK(r.rows[0].expanded_uncertainty == 0);
  CHECK(r.rows[0].run == 1);
  CHECK(r.source.place(r.rows[0].span.begin).line == 3);
  CHECK(r.metadata.at(0).second == "M");
  CHECK(r.rows[0].last_digit == doctest::Approx(0.001));
  const ValueRow counted =
      read_value_recording(SourceFile("v.csv", "characteristic,value,occurrence,run\nL,1,2,3\n")).rows.at(0);
  CHECK(counted.occurrence == 2);
  CHECK(counted.run == 3);
}

TEST_CASE("a recording of values is told by its header, whatever stands ahead of it") {
  for (const char* ahead :
       {"", "\xEF\xBB\xBF", "\xEF\xBB\xBF# made: today\n", "\n", " \n# characteristic of nothing\n"})
    for (const auto& [header, values] :
         {std::pair{"characteristic,value\nLEN,1\n", true}, std::pair{"value,\"characteristic\"\n1,LEN\n", true},
          std::pair{"feature,touch\nA,1\n", false}, std::pair{"label,value\nLEN,1\n", true},
          std::pair{"feature,touch,x,y,z,value\nA,1,0,0,0,1\n", false}})
      CHECK(is_value_recording(SourceFile("v.csv", std::string(ahead) + header)) == values);
}

TEST_CASE("a negative U and a run that is no count are refused, each with its place") {
  try {
    read_value_recording(
        SourceFile("v.csv", "characteristic,value,U,run\nLEN,1,-0.1,1\nLEN,1,0.1,1.5\n,1,0,1\nLEN,1,0,0\nLEN,1,0,1\n"));
    FAIL("accepted");
  } catch (const UserError& e) {
    CHECK(e.diagnostics().size() == 4);
  }
}

}  // namespace
}  // namespace abbe
