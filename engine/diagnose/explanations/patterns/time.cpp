#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/diagnose/explanations/parameter_grid.hpp"
#include "engine/diagnose/explanations/patterns/families.hpp"

namespace abbe::diagnose::patterns {

namespace {

/// One axis shifts and stretches along itself.
std::vector<Matrix> stretching(const TouchFactors& f) {
  std::vector<Matrix> out;
  const Matrix course = rugged(f.time, 0.2, 20);
  for (int k = 0; k < 3; ++k)
    out.push_back(component(f.normal, k).asDiagonal() *
                  products(side_by_side(constant(f.time.size()), from_middle(f.reading[k])), course));
  return out;
}

/// One axis is off by the distance along another.
std::vector<Matrix> leaning(const TouchFactors& f) {
  std::vector<Matrix> out;
  const Matrix course = rugged(f.time, 0.2, 20);
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j)
      if (j != k)
        out.push_back(Vector(component(f.normal, k).array() * from_middle(f.reading[j]).array()).asDiagonal() * course);
  return out;
}

/// So many cycles from the first touch to the last, of any phase.
Matrix wave(const Points& time, double cycles) {
  Matrix out(time.size(), 2);
  for (std::size_t i = 0; i < time.size(); ++i) {
    const double phase = 2 * kPi * cycles * time[i][0];
    out.row(static_cast<Eigen::Index>(i)) << std::cos(phase), std::sin(phase);
  }
  return out;
}

/// The part turns about its middle, back and forth at one frequency.
std::vector<Matrix> turning(const TouchFactors& f) {
  constexpr int kMostHalfCycles = 24;
  Vec3 middle;
  for (const auto& p : f.place) middle += Vec3{p[0], p[1], p[2]} / double(f.place.size());
  Directions turned;
  for (std::size_t i = 0; i < f.place.size(); ++i)
    turned.push_back(cross(Vec3{f.place[i][0], f.place[i][1], f.place[i][2]} - middle, f.normal[i]));
  std::vector<Matrix> out;
  for (int half_cycles = 1; half_cycles <= kMostHalfCycles; ++half_cycles)
    out.push_back(along(wave(f.time, 0.5 * half_cycles), turned));
  return out;
}

/// Everything swings in any direction, quicker than a room does (thermal.cycle): compressors, pumps, drums next door. The
/// shortest period is that of four touches; over the recording neighbours are seven tenths of a cycle apart, and what is
/// halfway shows in both.
std::vector<Family::Told> quick_cycles(const TouchFactors& f) {
  constexpr double kTouches = 4, kApart = 0.7;
  std::vector<Family::Told> out;
  for (double cycles = f.duration_s / quickest_of_a_room_s(f.duration_s); cycles <= double(f.time.size()) / kTouches;
       cycles += kApart) {
    const std::string period = f.timed ? fmt::format("{:.0f} s", f.duration_s / cycles)
                                       : fmt::format("{:.1f} touches", double(f.time.size()) / cycles);
    out.push_back({"a period of " + period, along(wave(f.time, cycles), f.normal)});
  }
  return out;
}

/// Whether there are ways between features, and most touches are not at the end of one.
bool ways_are_few(const TouchFactors& f) {
  constexpr std::ptrdiff_t kFew = 4;
  const auto at_end = [&](const Vec3& way) { return norm(way) > 0; };
  const std::ptrdiff_t ends = std::count_if(f.arriving.begin(), f.arriving.end(), at_end);
  return ends >= kFew && 3 * ends <= static_cast<std::ptrdiff_t>(f.arriving.size());
}

/// The first touch after the way to a feature, or the last before the way to the next: off along that way, at all speeds
/// alike or not, in any direction, or in size. Controllers wait too little, and what was moved fast goes on swinging.
std::vector<Family::Told> at_the_ends_of_ways(const TouchFactors& f) {
  std::vector<Family::Told> out;
  const std::pair<const Directions&, std::string> ends[] = {{f.arriving, "the first on each feature off"},
                                                            {f.leaving, "the last on each feature off"}};
  for (const auto& [way, which] : ends) {
    Matrix along_it = Matrix::Zero(static_cast<Eigen::Index>(way.size()), 1), at_it = along_it;
    for (std::size_t i = 0; i < way.size(); ++i) {
      along_it(static_cast<Eigen::Index>(i)) = dot(way[i], f.normal[i]);
      at_it(static_cast<Eigen::Index>(i)) = norm(way[i]);
    }
    const std::string along_way = which + " along the way between features";
    out.push_back({along_way, along_it});
    if (several(f.dynamics)) out.push_back({along_way + ", by speed and acceleration", by_group(along_it, f.dynamics)});
    out.push_back({which + " in one direction", along(at_it, f.normal)});
    out.push_back({which + " in size", at_it});
  }
  return out;
}

/// The probe moves on the head, in every direction or along one of its axes.
std::vector<Matrix> on_the_probe(const TouchFactors& f) {
  const Matrix course = rugged(f.time, 0.2, 24);
  std::vector<Matrix> out{along(course, f.normal_on_probe)};
  for (int k = 0; k < 3; ++k) out.push_back(component(f.normal_on_probe, k).asDiagonal() * course);
  return out;
}

/// What gathers on the tip, or wears off it, with every touch and not with the clock: on all styli alike, or
/// on each by itself.
std::vector<Matrix> sizes_along_the_sequence(const TouchFactors& f) {
  std::vector<Matrix> out{rugged(f.touch, 0.2, 40)};
  if (several(f.sensor)) out.push_back(by_group(rugged(f.touch, 0.2, 24), f.sensor));
  return out;
}

/// Along one axis of the machine or of the probe, or in size, from a few touches to the next.
std::vector<Matrix> from_touch_to_touch(const TouchFactors& f) {
  constexpr int kMost = 80;
  std::vector<Matrix> out;
  for (const Matrix& course :
       {rugged_over({{f.touch, stretch(f, 0.03, 6)}}, kMost), smooth_over({{f.touch, stretch(f, 0.01, 3)}}, kMost)}) {
    out.push_back(course);
    for (int k = 0; k < 3; ++k) {
      out.push_back(component(f.normal, k).asDiagonal() * course);
      if (several(f.orientation)) out.push_back(component(f.normal_on_probe, k).asDiagonal() * course);
    }
  }
  return out;
}

/// Over place and direction, for all styli and speeds alike or not.
std::vector<Matrix> over_place_and_direction(const TouchFactors& f) {
  constexpr int kMost = 100;
  const Within direction{as_points(f.normal), 0.9};
  return {smooth_over({{f.touch, stretch(f, 0.15, 4)}, {f.place, 0.5}, direction}, kMost),
          smooth_over({{f.touch, stretch(f, 0.05, 4)},
                       {f.place, 0.6},
                       direction,
                       {as_points(f.sensor), 0.7},
                       {as_points(f.dynamics), 0.7}},
                      kMost)};
}

}  // namespace

void over_time(const TouchFactors& f, Family& family) {
  family.add("slow", along(smooth(f.time, 0.3, 8), f.normal));
  family.add("quick", along(smooth(f.time, 0.07, 22), f.normal));
  family.add("rugged", along_all_or_one(rugged(f.time, 0.2, 40), f.normal));
  family.add("stretching", stretching(f));
  family.add("leaning", leaning(f));
  family.add("turning to and fro", turning(f));
  if (const auto cycles = quick_cycles(f); !cycles.empty()) family.add("quick cycles", cycles);
  if (ways_are_few(f)) family.add("first and last touches", at_the_ends_of_ways(f));
  family.add("size along the sequence", sizes_along_the_sequence(f));
  family.add_any("from touch to touch", from_touch_to_touch(f));
  if (!f.one_round) family.add_any("over place and direction", over_place_and_direction(f));
  if (several(f.orientation)) family.add("on the probe", on_the_probe(f));
}

}  // namespace abbe::diagnose::patterns
