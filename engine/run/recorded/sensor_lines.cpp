#include "engine/run/recorded/sensor_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "engine/math/units.hpp"
#include "engine/recording/sensor_line.hpp"

namespace abbe {

namespace {

/// What a line leaves out is as in a machine file.
NamedSensor sensor_of(const SensorLine& line) {
  NamedSensor s;
  const std::vector<double> head = line.numbers_or("head_deg", {0, 0}), tip = line.numbers_or("tip_in_r_mm", {});
  s.head_a_rad = head[0] * kDegree;
  s.head_b_rad = head[1] * kDegree;
  s.tip_in_r_mm = {tip[0], tip[1], tip[2]};
  s.radius_mm = line.number_or("diameter_mm", 0) / 2;
  s.shaft_diameter_mm = line.number_or("shaft_diameter_mm", s.radius_mm);
  s.young_GPa = line.number_or("young_GPa", NamedSensor::kUsualYoung_GPa);
  s.cte_ppm_per_K = line.number_or("cte_ppm_per_K", NamedSensor::kUsualCte_ppm_per_K);
  return s;
}

/// As far as a recording writes them.
bool same_geometry(const NamedSensor& a, const NamedSensor& b) {
  constexpr double kWritten_mm = 1e-3, kWritten_rad = 1e-5;
  return norm(a.tip_in_r_mm - b.tip_in_r_mm) < kWritten_mm && std::abs(a.radius_mm - b.radius_mm) < kWritten_mm &&
      std::abs(a.head_a_rad - b.head_a_rad) < kWritten_rad && std::abs(a.head_b_rad - b.head_b_rad) < kWritten_rad;
}

/// As far as a new qualification may move a stylus.
bool same_stylus(const NamedSensor& a, const NamedSensor& b) {
  constexpr double kQualified_mm = 1, kQualified_rad = 1 * kDegree;
  return norm(a.tip_in_r_mm - b.tip_in_r_mm) < kQualified_mm && std::abs(a.radius_mm - b.radius_mm) < kQualified_mm &&
      std::abs(a.head_a_rad - b.head_a_rad) < kQualified_rad && std::abs(a.head_b_rad - b.head_b_rad) < kQualified_rad;
}

std::string place_of(const NamedSensor& s) {
  const Vec3& t = s.tip_in_r_mm;
  return fmt::format("{:g} {:g} {:g} mm with head angles {:g} {:g} and a ball of {:g} mm", t.x, t.y, t.z,
                     in_degrees(s.head_a_rad), in_degrees(s.head_b_rad), 2 * s.radius_mm);
}

}  // namespace

std::pair<std::string, std::string> sensor_line(const Sensor& s, const Machine& machine) {
  // Whatever mounted it: where the tip is, seen from the head's centre of the machine file.
  const Vec3 tip = transpose(s.R_WR) * (s.tip_from_mount_mm + Vec3{0, 0, machine.head.l_r_mm});
  return {
      std::string(kSensorKey) + s.name,
      fmt::format(
          "head_deg {:.6g} {:.6g} tip_in_r_mm {:.6f} {:.6f} {:.6f} diameter_mm {:.6g} shaft_diameter_mm {:.6g} young_GPa {:.6g} cte_ppm_per_K {:.6g}",
          in_degrees(s.head_a_rad), in_degrees(s.head_b_rad), tip.x, tip.y, tip.z, 2 * s.radius_mm, s.shaft_diameter_mm,
          s.young_MPa / 1e3, 1e6 * s.cte_per_K)};
}

void add_recorded_sensors(const Recording& recording, Machine& machine, const std::string& file,
                          std::vector<Diagnostic>& messages) {
  std::map<std::string, NamedSensor, LabelOrder> described;
  for (const auto& [key, value] : recording.metadata) {
    if (!key.starts_with(kSensorKey)) continue;
    const std::string name = key.substr(kSensorKey.size());
    const SensorLine line = read_sensor_line(value);
    if (!line.mistake.empty())
      throw UserError(diagnostic(
          Code::E0545, fmt::format("{}: the line '# {}: {}' cannot be read: {}", file, key, value, line.mistake),
          kSensorLineHelp));
    const NamedSensor recorded = sensor_of(line);
    const auto [first, is_first] = described.emplace(name, recorded);
    if (!is_first && !same_stylus(first->second, recorded))
      throw UserError(
          diagnostic(Code::E0707,
                     fmt::format("{}: '{}' is the name of two styli: the tip of one is at {}, of the other at {}", file,
                                 name, place_of(first->second), place_of(recorded)),
                     "give each stylus a name of its own, in the rows and in the lines '# sensor'"));
    if (!is_first) continue;
    if (const auto known = machine.sensors.find(name);
        known != machine.sensors.end() && !same_geometry(known->second, recorded))
      messages.push_back(diagnostic(
          Code::N0718,
          fmt::format(
              "{}: stylus '{}' is another one than the machine file has under that name: that of the recording counts",
              file, name),
          fmt::format("its tip is at {}, and at {} in the machine file", place_of(recorded), place_of(known->second))));
    machine.sensors.insert_or_assign(name, recorded);
  }
}

}  // namespace abbe
