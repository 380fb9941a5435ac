// A sensor of the program or of the machine file, as it hangs on the machine.
#include "engine/run/sensor.hpp"

#include <doctest/doctest.h>

#include "tests/unit/run/plan_builder.hpp"

using namespace abbe;
using namespace abbe::test;

namespace {

void check_near(const Vec3& is, const Vec3& expected) { CHECK(norm(is - expected) < 1e-9); }

}  // namespace

TEST_CASE("the tip stands below the head's centre, turned as the head and its mounting are") {
  Machine machine = read_machine("coord3-mc16");
  machine.head.l_r_mm = 80;
  machine.head.mounting_rad = kPi / 2;
  plan::SensorDef def;
  def.indexed = true, def.tip_in_r = {0, 0, -150}, def.radius_mm = 2;
  check_near(resolve_sensor(def, machine, no_source()).tip_from_mount_mm, {0, 0, -230});
  // A = 90 swings the stylus out along x of the head, which the mounting has turned to y.
  def.head_a_rad = kPi / 2;
  const Sensor lying = resolve_sensor(def, machine, no_source());
  check_near(lying.tip_from_mount_mm, {0, 150, -80});
  check_near(lying.to_head, {0, -1, 0});
  check_near(lying.R_WR.cz, {0, -1, 0});
  check_near(lying.per_rad_a_mm, {0, 0, 150});
  check_near(lying.per_rad_b_mm, {-150, 0, 0});
}

TEST_CASE("a stylus of the machine file is of its own material, any other of tungsten carbide") {
  Machine machine = read_machine("coord3-mc16");
  machine.sensors["S"] = {0, 0, {0, 0, -100}, 2, 1.5, "steel", 200, 11.5};
  plan::SensorDef def;
  def.label = "S", def.from_machine_file = true;
  const Sensor named = resolve_sensor(def, machine, no_source());
  CHECK(named.young_MPa == doctest::Approx(200e3));
  CHECK(named.cte_per_K == doctest::Approx(11.5e-6).scale(0));
  CHECK(named.shaft_diameter_mm == 1.5);
  def = {};
  def.tip_in_r = {0, 0, -100}, def.radius_mm = 2;
  const Sensor written = resolve_sensor(def, machine, no_source());
  CHECK(written.young_MPa == doctest::Approx(620e3));
  CHECK(written.shaft_diameter_mm == 2);
}
