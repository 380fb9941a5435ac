#include "engine/diagnose/planning/changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "engine/diagnose/planning/reach.hpp"
#include "engine/diagnose/quantile.hpp"
#include "engine/math/units.hpp"
#include "engine/run/motion.hpp"

namespace abbe::diagnose {

namespace {

template <class Value>
double median_of(const Case& c, Value value) {
  std::vector<double> v;
  for (const RecordedTouch& t : c.touches.touches) v.push_back(value(t.scene));
  return median(std::move(v));
}

bool logged(const Case& c, Covariate what) { return (c.touches.known & static_cast<unsigned>(what)) != 0; }

/// Changes of the program alone.
void add_motion(const Case& c, std::vector<Change>& list) {
  if (logged(c, Covariate::speed)) {
    const double speed = median_of(c, [](const TouchScene&s) { return s.speed_mm_s; }),
                 other = speed > 5 ? speed / 3 : 3 * speed;
    if (other > 0)
      list.push_back({.text = fmt::format("repeat with probing speed {:.3g} mm/s", other),
                      .apply = [=](RecordingRow& row, Machine&) { row.speed_mm_s = other; }});
  }
  if (logged(c, Covariate::acceleration)) {
    const double other = median_of(c, [](const TouchScene& s) { return s.acceleration_mm_s2; }) / 3;
    if (other > 0)
      list.push_back({.text = fmt::format("repeat with acceleration {:.3g} mm/s2", other),
                      .apply = [=](RecordingRow& row, Machine&) { row.accel_mm_s2 = other; }});
  }
  list.push_back({.text = "repeat the whole sequence once more", .changes_touches = false});
  list.push_back({.text = "repeat the whole sequence in reverse order", .reversed = true, .changes_touches = false});
}

/// A stylus system like that of the row but for `alter`, under a name of its own.
template <class Alter>
void mount(RecordingRow& row, Machine& machine, const std::string& suffix, Alter alter) {
  const std::string name = *row.sensor + suffix;
  NamedSensor s = machine.sensors.at(*row.sensor);
  alter(s);
  machine.sensors.emplace(name, s);
  row.sensor = name;
  row.qualification = row.qualification.value_or(1) + 1;
}

/// Styli are sold in steps of 10 mm.
double sold_length_mm(double about_mm) { return std::max(1.0, std::round(about_mm / 10)) * 10; }

/// Other styli and orientations of the head; only of styli that the machine file describes.
void add_styli(const Case& c, std::vector<Change>& list) {
  const std::vector<RecordingRow>& rows = c.recording->rows;
  if (!std::all_of(rows.begin(), rows.end(),
                   [&](const RecordingRow& r) { return r.sensor && c.machine->sensors.count(*r.sensor) > 0; }))
    return;
  list.push_back({.text = "repeat with the stylus qualified anew",
                  .instruction = "qualify the stylus anew, in all orientations",
                  .minutes = 5,
                  .apply = [](RecordingRow& row, Machine&) { row.qualification = row.qualification.value_or(1) + 1; }});
  const double length = median_of(c, [](const TouchScene&s) { return s.stylus.length_mm; }),
               other = sold_length_mm(length > 60 ? length / 3 : 2 * length);
  list.push_back({.text = fmt::format("repeat with a stylus of {:.0f} mm", other),
                  .instruction = fmt::format("mount a stylus of {:.0f} mm and qualify it", other),
                  .minutes = 5,
                  .apply =
                      [=](RecordingRow& row, Machine& machine) {
                        mount(row, machine, fmt::format("_L{:.0f}", other),
                              [&](NamedSensor& s) { s.tip_in_r_mm = other / norm(s.tip_in_r_mm) * s.tip_in_r_mm; });
                      },
                  .mounted = fmt::format("a length of {:.0f} mm", other)});
  const double ball = 2 * median_of(c, [](const TouchScene&s) { return s.stylus.radius_mm; }),
               other_ball = ball > 3 ? ball / 2 : 2 * ball;
  list.push_back(
      {.text = fmt::format("repeat with a stylus ball of {:.3g} mm", other_ball),
       .instruction =
           fmt::format("mount a stylus of the same length with a ball of {:.3g} mm and qualify it", other_ball),
       .minutes = 5,
       .apply =
           [=, centre = c.recording->point == RecordedPoint::tip_centre](RecordingRow& row, Machine& machine) {
             const double by = other_ball / 2 - machine.sensors.at(*row.sensor).radius_mm;
             mount(row, machine, fmt::format("_D{:.0f}", 1000 * other_ball),
                   [&](NamedSensor& s) { s.radius_mm = other_ball / 2; });
             if (centre) *row.target_mm += by * *row.normal;  // the surface stays
           },
       .mounted = fmt::format("a ball of {:.3g} mm", other_ball)});
  // A star would reach other places of the part when it is turned.
  if (!std::all_of(rows.begin(), rows.end(),
                   [&](const RecordingRow& r) { return is_straight(c.machine->sensors.at(*r.sensor).tip_in_r_mm); }))
    return;
  if (!std::any_of(c.touches.touches.begin(), c.touches.touches.end(),
                   [](const RecordedTouch& t) { return t.scene.stylus.indexed; }))
    return;
  list.push_back({.text = "repeat with the head turned by B + 60 degrees",
                  .instruction = "qualify the stylus in the new orientations",
                  .minutes = 3,
                  .apply = [](RecordingRow& row, Machine& machine) {
                    mount(row, machine, "_B60", [&](NamedSensor& s) {
                      if (row.head_b_deg) s.head_b_rad = *row.head_b_deg * kDegree;
                      s.head_b_rad = std::remainder(s.head_b_rad + kPi / 3, 2 * kPi);
                      if (row.head_b_deg) row.head_b_deg = in_degrees(s.head_b_rad);
                    });
                  }});
}

/// The part turned by R about the middle of its touches, then moved.
Rigid moved(const Case& c, const Mat3& R, const Vec3& by) {
  Vec3 middle;
  const std::vector<RecordingRow>& rows = c.recording->rows;
  for (const RecordingRow& row : rows) middle += *row.target_mm / double(rows.size());
  return {R, middle + by - R * middle};
}

/// How far the touches can be raised (positive) or lowered, mm: 200 at most, and whichever there is more room for.
double room_above_or_below(const Case& c) {
  double low = 1e9, high = -1e9;
  for (const RecordedTouch& t : c.touches.touches)
    low = std::min(low, t.scene.reading.z), high = std::max(high, t.scene.reading.z);
  const MachineAxis& z = (*c.machine)[Axis::z];
  const double above = z.highest_mm() - high, below = low - z.lowest_mm();
  constexpr double kMargin_mm = 10, kFar_mm = 200;
  const double by = std::min(kFar_mm, std::floor((std::max(above, below) - kMargin_mm) / 10) * 10);
  return above >= below ? by : -by;
}

/// How many surfaces the stylus does not reach when the part is turned so.
std::ptrdiff_t beyond_reach(const Case& c, const Mat3& turn) {
  const std::vector<RecordedTouch>& all = c.touches.touches;
  return std::count_if(all.begin(), all.end(), [&, least = least_facing(c.touches)](const RecordedTouch& t) {
    return facing(turn * t.scene.normal, t.scene.stylus) < least;
  });
}

void add_placements(const Case& c, std::vector<Change>& list) {
  list.push_back({.text = "repeat with the part clamped anew",
                  .instruction = "release the part and clamp it again in the same place",
                  .minutes = 5,
                  .new_setup = true});
  if (c.recording->in_part_frame) return;  // where the part stood was not recorded
  const auto turned = [&](const std::string& how, const Vec3& axis, double angle_rad) {
    list.push_back(placed_anew(how, moved(c, rotation(axis, angle_rad), {})));
  };
  turned("turned by 90 degrees about the vertical", {0, 0, 1}, kPi / 2);
  turned("turned by 180 degrees about the vertical", {0, 0, 1}, kPi);
  const auto tilted = [&](char name, const Vec3& axis) {  // to the side on which more can be touched
    constexpr double kTilt_rad = kPi / 9;
    const bool back = beyond_reach(c, rotation(axis, -kTilt_rad)) < beyond_reach(c, rotation(axis, kTilt_rad));
    const double by_rad = back ? -kTilt_rad : kTilt_rad;
    turned(fmt::format("tilted by {:.0f} degrees about {}", in_degrees(by_rad), name), axis, by_rad);
  };
  tilted('X', {1, 0, 0}), tilted('Y', {0, 1, 0});
  const double height = room_above_or_below(c);
  constexpr double kWorthIt_mm = 50;
  if (std::abs(height) < kWorthIt_mm) return;
  const std::string how = fmt::format("{} by {:.0f} mm", height > 0 ? "raised" : "lowered", std::abs(height));
  list.push_back(placed_anew(how, moved(c, Mat3{}, {0, 0, height})));
}

void add_conditions(const Case& c, std::vector<Change>& list) {
  if (logged(c, Covariate::part_temperature) || logged(c, Covariate::scale_temperature))
    list.push_back({.text = "repeat with part and scales at a temperature 2 K higher",
                    .instruction = "let part, machine and room settle 2 K higher; log the temperatures",
                    .minutes = 240,
                    .apply =
                        [](RecordingRow& row, Machine&) {
                          for (std::optional<double>* t :
                               {&row.temp_part_C, &row.temp_x_C, &row.temp_y_C, &row.temp_z_C, &row.temp_air_C})
                            if (*t) **t += 2;
                        },
                    .new_setup = true});  // in hours a part does not stay put to micrometres
  if (logged(c, Covariate::load))
    list.push_back({.text = "repeat with 200 kg more on the table",
                    .instruction = "put 200 kg beside the part",
                    .minutes = 15,
                    .apply = [](RecordingRow& row, Machine&) { *row.load_kg += 200; }});
}

}  // namespace

Change placed_anew(const std::string& how, const Rigid& move) {
  return {.text = "repeat with the part " + how,
          .instruction = "place the part " + how + " and align it again",
          .minutes = 10,
          .move = move,
          .placed = how,
          .new_setup = true};
}

Change joined(const Change& a, const Change& b) {
  if (a.move && b.move) {  // it is put down once
    Change out = placed_anew(a.placed + " and then " + b.placed, *b.move * *a.move);
    out.minutes = a.minutes + b.minutes;
    return out;
  }
  constexpr std::string_view kRepeat = "repeat ";
  const auto both = [](const std::string& x, const std::string& y, std::string_view between) {
    return x.empty() || y.empty() ? x + y : x + std::string(between) + y;
  };
  const bool one_stylus = !a.mounted.empty() && !b.mounted.empty();
  return {.text = a.text + " and " + b.text.substr(kRepeat.size()),
          .instruction = one_stylus ? "mount a stylus with " + a.mounted + " and " + b.mounted + ", and qualify it"
                                    : both(a.instruction, b.instruction, "; "),
          .minutes = one_stylus ? a.minutes : a.minutes + b.minutes,
          .apply = [a, b](RecordingRow& row, Machine& machine) { a.apply(row, machine), b.apply(row, machine); },
          .move = a.move ? a.move : b.move,
          .new_setup = a.new_setup || b.new_setup,
          .reversed = a.reversed || b.reversed};
}

std::vector<Change> changes_for(const Case& c) {
  std::vector<Change> list;
  add_motion(c, list);
  add_styli(c, list);
  add_placements(c, list);
  add_conditions(c, list);
  return list;
}

}  // namespace abbe::diagnose
