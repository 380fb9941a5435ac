#include "engine/run/sensor.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/machine/head.hpp"

namespace abbe {

namespace {

bool same_label(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return lower(x) == lower(y); });
}

/// The definition with everything that the machine file says of a sensor filled in.
plan::SensorDef from_machine_file(plan::SensorDef def, const Machine& machine, const SourceFile& source) {
  for (const auto& [name, sensor] : machine.sensors) {
    if (!same_label(name, def.label)) continue;
    def.indexed = true;
    def.head_a_rad = sensor.head_a_rad;
    def.head_b_rad = sensor.head_b_rad;
    def.tip_in_r = sensor.tip_in_r_mm;
    def.radius_mm = sensor.radius_mm;
    return def;
  }
  std::vector<std::string_view> names;
  for (const auto& entry : machine.sensors) names.push_back(entry.first);
  const std::string near = nearest_word(def.label, names);
  throw UserError(diagnostic_at(
      source, def.span, Code::E0301, fmt::format("machine '{}' has no sensor '{}'", machine.name, def.label),
      !near.empty() ? fmt::format("did you mean '{}'?", near)
                    : "define it in the program with SNSDEF, or add it to \"sensors\" in the machine file"));
}

}  // namespace

Sensor resolve_sensor(const plan::SensorDef& definition, const Machine& machine, const SourceFile& source) {
  const plan::SensorDef def =
      definition.from_machine_file ? from_machine_file(definition, machine, source) : definition;
  const double turn = def.has_mount ? def.mount_turn_rad : machine.head.mounting_rad;
  const Mat3 R_mounting = rotation({0, 0, 1}, turn);
  Sensor s;
  s.indexed = def.indexed;
  s.radius_mm = def.radius_mm;
  if (!def.indexed) {
    s.R_WR = R_mounting;
    s.tip_from_mount_mm = R_mounting * def.tip_in_r + (def.has_mount ? def.mount_offset_mm : Vec3{});
    return s;
  }
  s.head_a_rad = def.head_a_rad;
  s.head_b_rad = def.head_b_rad;
  s.R_WR = R_mounting * head_rotation(def.head_a_rad, def.head_b_rad);
  const Vec3 head_centre = def.has_mount ? def.mount_offset_mm : Vec3{0, 0, -machine.head.l_r_mm};
  s.tip_from_mount_mm = s.R_WR * def.tip_in_r + head_centre;
  s.per_rad_a_mm = R_mounting * head_derivative_a(def.head_a_rad, def.head_b_rad, def.tip_in_r);
  s.per_rad_b_mm = R_mounting * head_derivative_b(def.head_a_rad, def.head_b_rad, def.tip_in_r);
  return s;
}

}  // namespace abbe
