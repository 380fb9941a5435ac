#include "engine/run/recorded/sensor_lines.hpp"

#include <doctest/doctest.h>

#include "engine/base/diagnostic.hpp"

using namespace abbe;

namespace {

NamedSensor sensor_read(const std::string& line) {
  Recording r;
  r.metadata = {{"sensor T", line}};
  Machine machine;
  std::vector<Diagnostic> messages;
  add_recorded_sensors(r, machine, "r.csv", messages);
  CHECK(messages.empty());
  return machine.sensors.at("T");
}

/// The message about a line; empty when it was read.
std::string sensor_refusal(const std::string& line) {
  try {
    sensor_read(line);
    return "";
  } catch (const UserError& e) {
    CHECK(e.diagnostics().front().code == Code::E0545);
    return e.diagnostics().front().message;
  }
}

bool holds(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("a sensor line says what a machine file says, and leaves out the same") {
  const NamedSensor s = sensor_read(
      "head_deg 90 -90 tip_in_r_mm 1 2 -100 diameter_mm 4 shaft_diameter_mm 1.5 young_GPa 200 cte_ppm_per_K -0.4");
  CHECK(s.head_a_rad == doctest::Approx(kPi / 2));
  CHECK(s.head_b_rad == doctest::Approx(-kPi / 2));
  CHECK(s.tip_in_r_mm == Vec3{1, 2, -100});
  CHECK(s.radius_mm == 2);
  CHECK(s.shaft_diameter_mm == 1.5);
  CHECK(s.young_GPa == 200);
  CHECK(s.cte_ppm_per_K == -0.4);
  const NamedSensor usual = sensor_read("diameter_mm 4 tip_in_r_mm 0 0 -100");
  CHECK(usual.head_a_rad == 0);
  CHECK(usual.shaft_diameter_mm == 2);  // half as thick as the ball, of tungsten carbide
  CHECK(usual.young_GPa == 620);
  CHECK(usual.cte_ppm_per_K == 5);
}

TEST_CASE("a sensor line that says too little, too much or what cannot be is refused (E0545)") {
  const std::string good = "tip_in_r_mm 0 0 -100 diameter_mm 3";
  CHECK(sensor_refusal(good).empty());
  CHECK(holds(sensor_refusal("diameter_mm 3"), "tip_in_r_mm is missing"));
  CHECK(holds(sensor_refusal("tip_in_r_mm 0 0 -100"), "diameter_mm is missing"));
  CHECK(holds(sensor_refusal(""), "is missing"));
  CHECK(holds(sensor_refusal(good + " head_deg 90"), "head_deg has 1 of 2 numbers"));
  CHECK(holds(sensor_refusal(good + " young_GPa"), "young_GPa has 0 of 1 numbers"));
  CHECK(holds(sensor_refusal(good + " young_GPa 0"), "'0' of young_GPa must be greater than 0"));
  CHECK(holds(sensor_refusal(good + " shaft_diameter_mm -1"), "'-1' of shaft_diameter_mm must be greater than 0"));
  CHECK(holds(sensor_refusal("tip_in_r_mm 0 0 -100 diameter_mm 0"), "must be greater than 0"));
  CHECK(holds(sensor_refusal("tip_in_r_mm 0 nan -100 diameter_mm 3"), "'nan' of tip_in_r_mm must be between"));
  CHECK(holds(sensor_refusal(good + " cte_ppm_per_K inf"), "must be between -100 and 1000"));
  CHECK(holds(sensor_refusal(good + " head_deg 400 0"), "'400' of head_deg must be between -360 and 360"));
  CHECK(holds(sensor_refusal(good + " shaft_diameter_mm 3.1"), "shaft is thicker than the ball"));
  CHECK(holds(sensor_refusal(good + " diameter_mm 4"), "twice"));
  CHECK(holds(sensor_refusal(good + " 7"), "'7' stands where"));
}

TEST_CASE("of one name the stylus of the recording counts, and another one is told") {
  const auto said = [](const std::string& tip) {
    Recording r;
    r.metadata = {{"sensor t", "head_deg 90 0 tip_in_r_mm " + tip + " diameter_mm 4"}};
    Machine machine;
    machine.sensors["T"].head_a_rad = kPi / 2, machine.sensors["T"].tip_in_r_mm = {0, 0, -150},
    machine.sensors["T"].radius_mm = 2;
    std::vector<Diagnostic> messages;
    add_recorded_sensors(r, machine, "r.csv", messages);
    return std::pair{machine.sensors.at("T").tip_in_r_mm.z, messages};
  };
  const auto [z, messages] = said("0 0 -100");
  CHECK(z == -100);
  REQUIRE(messages.size() == 1);
  CHECK(messages[0].code == Code::N0718);
  CHECK(holds(messages[0].help, "-150"));
  CHECK(said("0 0 -150.0001").second.empty());
}
