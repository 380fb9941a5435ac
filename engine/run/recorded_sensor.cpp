#include "engine/run/recorded_sensor.hpp"

#include <fmt/format.h>

#include <sstream>

namespace abbe {

namespace {

constexpr std::string_view kKey = "sensor ";
constexpr double kDegree = kPi / 180;

}  // namespace

std::pair<std::string, std::string> sensor_line(const Sensor& s, const Machine& machine) {
  // Whatever mounted it: where the tip is, seen from the head's centre of the machine file.
  const Vec3 tip = transpose(s.R_WR) * (s.tip_from_mount_mm + Vec3{0, 0, machine.head.l_r_mm});
  return {std::string(kKey) + s.name,
          fmt::format("head_deg {:.6g} {:.6g} tip_in_r_mm {:.6f} {:.6f} {:.6f} diameter_mm {:.6g} shaft_diameter_mm {:.6g} young_GPa {:.6g} cte_ppm_per_K {:.6g}",
                      s.head_a_rad / kDegree, s.head_b_rad / kDegree, tip.x, tip.y, tip.z, 2 * s.radius_mm, s.shaft_diameter_mm, s.young_MPa / 1e3, 1e6 * s.cte_per_K)};
}

void add_recorded_sensors(const Recording& recording, Machine& machine, const std::string& file) {
  for (const auto& [key, value] : recording.metadata) {
    if (!key.starts_with(kKey)) continue;
    std::istringstream in(value);
    NamedSensor s;
    double a = 0, b = 0, diameter = 0;
    for (std::string word; in >> word;) {
      if (word == "head_deg") in >> a >> b;
      else if (word == "tip_in_r_mm") in >> s.tip_in_r_mm.x >> s.tip_in_r_mm.y >> s.tip_in_r_mm.z;
      else if (word == "diameter_mm") in >> diameter;
      else if (word == "shaft_diameter_mm") in >> s.shaft_diameter_mm;
      else if (word == "young_GPa") in >> s.young_GPa;
      else if (word == "cte_ppm_per_K") in >> s.cte_ppm_per_K;
      else in.setstate(std::ios::failbit);
    }
    if (!in.eof() || diameter <= 0)
      throw UserError(diagnostic(Code::E0545, fmt::format("{}: the line '# {}: {}' cannot be read", file, key, value),
                                 "write head_deg A B tip_in_r_mm x y z diameter_mm d, numbers between blanks"));
    s.head_a_rad = a * kDegree;
    s.head_b_rad = b * kDegree;
    s.radius_mm = diameter / 2;
    machine.sensors.emplace(key.substr(kKey.size()), s);
  }
}

}  // namespace abbe
