#include "engine/run/sensor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/machine/head.hpp"
#include "engine/math/units.hpp"

namespace abbe {

namespace {

const NamedSensor& machine_sensor(const plan::SensorDef& def, const Machine& machine, const SourceFile& source) {
  if (const auto found = machine.sensors.find(def.label); found != machine.sensors.end()) return found->second;
  std::vector<std::string_view> names;
  for (const auto& [name, sensor] : machine.sensors) names.push_back(name);
  const std::string near = nearest_word(def.label, names);
  throw UserError(diagnostic_at(
      source, def.span, Code::E0301, fmt::format("machine '{}' has no sensor '{}'", machine.name, def.label),
      fmt::format("{}define it in the program with SNSDEF, or add it to \"sensors\" in the machine file",
                  near.empty() ? "" : fmt::format("did you mean '{}'? Else ", near))));
}

/// The definition with what the machine file says of the sensor.
plan::SensorDef filled_in(plan::SensorDef def, const NamedSensor& sensor, bool indexed) {
  def.indexed = indexed;
  def.head_a_rad = sensor.head_a_rad;
  def.head_b_rad = sensor.head_b_rad;
  def.tip_in_r = sensor.tip_in_r_mm;
  def.radius_mm = sensor.radius_mm;
  return def;
}

}  // namespace

int stylus_ordinal(const Sensor& sensor, const std::vector<Sensor>& before) {
  constexpr double kSame_mm = 1e-6;
  int next = 1;
  for (const Sensor& other : before) {
    const bool same = norm(other.tip_in_r_mm - sensor.tip_in_r_mm) < kSame_mm &&
        std::abs(other.radius_mm - sensor.radius_mm) < kSame_mm &&
        std::abs(other.shaft_diameter_mm - sensor.shaft_diameter_mm) < kSame_mm && other.indexed == sensor.indexed;
    if (same) return other.ordinal;
    next = std::max(next, other.ordinal + 1);
  }
  return next;
}

Sensor resolve_sensor(const plan::SensorDef& definition, const Machine& machine, const SourceFile& source) {
  const NamedSensor* named = definition.from_machine_file ? &machine_sensor(definition, machine, source) : nullptr;
  const plan::SensorDef def = named ? filled_in(definition, *named, machine.has_head()) : definition;
  const double turn = def.has_mount ? def.mount_turn_rad : machine.head.mounting_rad;
  const Mat3 R_mounting = rotation({0, 0, 1}, turn);
  Sensor s;
  s.name = def.label;
  // SNSDEF says nothing of the stylus: a shaft of tungsten carbide half as thick as the ball is what one
  // would screw in.
  s.shaft_diameter_mm = named && named->shaft_diameter_mm > 0 ? named->shaft_diameter_mm : def.radius_mm;
  s.young_MPa = 1000 * (named ? named->young_GPa : NamedSensor::kUsualYoung_GPa);
  s.cte_per_K = kPpm * (named ? named->cte_ppm_per_K : NamedSensor::kUsualCte_ppm_per_K);
  s.length_mm = norm(def.tip_in_r);
  s.tip_in_r_mm = def.tip_in_r;
  s.indexed = def.indexed;
  s.radius_mm = def.radius_mm;
  if (!def.indexed) {
    s.R_WR = R_mounting;
    s.tip_from_mount_mm = R_mounting * def.tip_in_r + (def.has_mount ? def.mount_offset_mm : Vec3{});
    if (s.length_mm > 0) s.to_head = -(R_mounting * unit(def.tip_in_r));
    return s;
  }
  s.head_a_rad = def.head_a_rad;
  s.head_b_rad = def.head_b_rad;
  s.R_WR = R_mounting * head_rotation(def.head_a_rad, def.head_b_rad);
  const Vec3 head_centre = def.has_mount ? def.mount_offset_mm : Vec3{0, 0, -machine.head.l_r_mm};
  s.tip_from_mount_mm = s.R_WR * def.tip_in_r + head_centre;
  if (s.length_mm > 0) s.to_head = -(s.R_WR * unit(def.tip_in_r));
  s.per_rad_a_mm = R_mounting * head_derivative_a(def.head_a_rad, def.head_b_rad, def.tip_in_r);
  s.per_rad_b_mm = R_mounting * head_derivative_b(def.head_a_rad, def.head_b_rad, def.tip_in_r);
  return s;
}

}  // namespace abbe
