#include "engine/figures/scenes.hpp"

#include <algorithm>
#include <iterator>

#include "engine/machine/geometry.hpp"
#include "engine/machine/head.hpp"
#include "engine/math/units.hpp"

namespace abbe {

namespace {

using Touch = StandardTouch;

constexpr Sweep kSweeps[] = {
    {"raw reading beyond that of the middle, mm", Covariate::raw_reading, 0, 0.1, 0, 0.01,
     [](Touch& t, double v) {
       t.reading_mm += {v, v, v};
     }},
    {"visit to the orientation", Covariate::visit, 0, 12, 0, 1, [](Touch& t, double v) { t.visit = v; }},
    {"time since the start, min", Covariate::time, 0, 180, 30, 120, [](Touch& t, double v) { t.time_s = 60 * v; }},
    {"probing speed, mm/s", Covariate::speed, 0, 10, 2, 8, [](Touch& t, double v) { t.speed_mm_s = v; }},
    {"time at constant speed before the touch, s", Covariate::acceleration, 0, 0.5, 0.05, 0.2,
     [](Touch& t, double v) { t.settled_s = v; }},
    {"angle between approach and normal, °", Covariate::direction, -20, 20, 5, 10,
     [](Touch& t, double v) { t.askew_deg = v; }},
    {"path of the axes, mm; they turn back at 20", Covariate::direction, 0, 2 * kTurn_mm, 10, 30,
     [](Touch& t, double v) { t.path_mm = v; }},
    {"x on the part, mm", Covariate::part_frame, -250, 250, 100, 200, [](Touch& t, double v) { t.on_part_mm.x = v; }},
    {"y on the part, mm", Covariate::part_frame, -250, 250, 100, 200, [](Touch& t, double v) { t.on_part_mm.y = v; }},
    {"z on the part, mm", Covariate::part_frame, -250, 250, 100, 200, [](Touch& t, double v) { t.on_part_mm.z = v; }},
    {"reading of x, mm", Covariate::position, 0, 1600, 200, 1400, [](Touch& t, double v) { t.reading_mm.x = v; }},
    {"reading of y, mm", Covariate::position, 0, 1000, 200, 800, [](Touch& t, double v) { t.reading_mm.y = v; }},
    {"reading of z, mm", Covariate::position, -800, 0, -800, -100, [](Touch& t, double v) { t.reading_mm.z = v; }},
    {"azimuth of the normal, °", Covariate::normal, 0, 360, 0, 60, [](Touch& t, double v) { t.azimuth_deg = v; }, true},
    {"elevation of the normal, °", Covariate::normal, 0, 90, 0, 45, [](Touch& t, double v) { t.elevation_deg = v; },
     true},
    {"temperature of the part, °C", Covariate::part_temperature, 15, 25, 18, 22,
     [](Touch& t, double v) { t.part_C = v; }},
    {"temperature of the scales, °C", Covariate::scale_temperature, 15, 25, 18, 22,
     [](Touch& t, double v) { t.scale_C = v; }},
    {"temperature of the air, °C", Covariate::air_temperature, 15, 25, 18, 22, [](Touch& t, double v) { t.air_C = v; }},
    {"temperature difference in table and bridge, K", Covariate::gradients, -1, 1, -0.5, 0.5,
     [](Touch& t, double v) { t.gradient_K = v; }},
    {"head angle A, °", Covariate::head, -90, 90, 0, 90, [](Touch& t, double v) { t.head_a_deg = v; }},
    {"head angle B, °", Covariate::head, -180, 180, 0, 90, [](Touch& t, double v) { t.head_b_deg = v; }},
    {"length of the stylus, mm", Covariate::sensor, 20, 200, 50, 100, [](Touch& t, double v) { t.stylus_mm = v; }},
    {"radius of the tip, mm", Covariate::sensor, 0.25, 4, 1, 2, [](Touch& t, double v) { t.tip_radius_mm = v; }},
    {"load on the table, kg", Covariate::load, 0, 1000, 100, 500, [](Touch& t, double v) { t.load_kg = v; }},
};

Vec3 direction(double azimuth_deg, double elevation_deg) {
  const double a = azimuth_deg * kDegree, e = elevation_deg * kDegree;
  return {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
}

StylusScene stylus_of(const StandardTouch& t) {
  StylusScene s;
  s.name = "standard";
  s.head_a_rad = t.head_a_deg * kDegree, s.head_b_rad = t.head_b_deg * kDegree;
  s.R_WR = head_rotation(s.head_a_rad, s.head_b_rad);
  s.to_head = s.R_WR.cz;
  s.tip_from_mount_mm = -t.stylus_mm * s.to_head;
  s.length_mm = t.stylus_mm;
  s.radius_mm = t.tip_radius_mm;
  s.shaft_diameter_mm = 4;  // carbide, as one would take for 100 mm
  s.young_MPa = 1000 * NamedSensor::kUsualYoung_GPa;
  s.cte_per_K = kPpm * NamedSensor::kUsualCte_ppm_per_K;
  s.indexed = true;
  return s;
}

}  // namespace

TouchScene scene_of(const StandardTouch& t, const Machine& machine) {
  TouchScene s;
  s.stylus = stylus_of(t);
  s.reading = t.reading_mm;
  s.point = machine.home_offset() + t.reading_mm + s.stylus.tip_from_mount_mm;
  s.normal = s.normal_on_part = direction(t.azimuth_deg, t.elevation_deg);
  const Vec3 across = direction(t.azimuth_deg, t.elevation_deg + 90);
  const double askew = t.askew_deg * kDegree;
  s.travel = -(std::cos(askew) * s.normal + std::sin(askew) * across);
  s.on_part = t.on_part_mm;
  s.time_s = t.time_s;
  s.speed_mm_s = t.speed_mm_s;
  s.acceleration_mm_s2 = t.acceleration_mm_s2;
  s.settled_s = t.settled_s;
  const bool back = t.path_mm >= kTurn_mm;
  std::fill(s.sense, s.sense + 3, back ? -1 : 1);
  std::fill(s.since_reversal_mm, s.since_reversal_mm + 3, back ? t.path_mm - kTurn_mm : t.path_mm);
  s.temperature = {t.part_C, t.air_C, {t.scale_C, t.scale_C, t.scale_C}, t.gradient_K, t.gradient_K, t.gradient_K};
  s.load_kg = t.load_kg;
  s.visit = static_cast<int>(t.visit);
  for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
    const int k = static_cast<int>(axis);
    s.travel_length_mm[k] = machine[axis].travel_mm;
    s.lever_mm[k] = axis_lever(machine, axis).at(s.reading, s.stylus.tip_from_mount_mm);
  }
  return s;
}

std::span<const Sweep> sweeps() { return kSweeps; }

}  // namespace abbe
