#include <algorithm>
#include <utility>

#include "engine/diagnose/explanations/patterns/families.hpp"

namespace abbe::diagnose::patterns {

namespace {

/// Two to nine lobes about the axis of the probe, greatest on its equator: fixed to the probe.
std::vector<Matrix> lobes_of_the_probe(const TouchFactors& f) {
  std::vector<Matrix> out;
  for (int count = 2; count <= 9; ++count) out.push_back(lobes(f.normal_on_probe, 2, count));
  return out;
}

/// A probe that does not come home: displaced on the head by the direction of the touch before, of all styli
/// alike, or of each by itself.
std::vector<Matrix> after_the_touch_before(const TouchFactors& f) {
  const Matrix before = along(constant(f.before_on_probe.size()), f.before_on_probe);
  std::vector<Matrix> out{along(before, f.normal_on_probe)};
  if (several(f.sensor)) out.push_back(by_group(out.front(), f.sensor));
  return out;
}

/// What oblique approaches drag along the surface, in proportion or by its direction alone; of all styli
/// alike, or of each by itself.
std::vector<Matrix> skidding(const TouchFactors& f) {
  constexpr double kNone = 0.02;
  Directions way = f.skid;
  for (Vec3& v : way) v = v / std::max(norm(v), kNone);
  const Matrix over = side_by_side(constant(f.skid.size()), smooth(as_points(f.normal_on_probe), 0.9, 8));
  std::vector<Matrix> out;
  for (const Directions& dragged : {f.skid, way}) {
    out.push_back(along(over, dragged));
    if (several(f.sensor)) out.push_back(by_group(out.back(), f.sensor));
  }
  return out;
}

/// What comes and goes on one side of a tip, of each stylus by itself.
std::vector<Matrix> sides_of_tips(const TouchFactors& f) {
  constexpr int kMost = 150;
  constexpr std::pair<double, double> kWithin[] = {{0.15, 0.8}, {0.05, 0.5}, {0.02, 0.8}};  // time, direction
  std::vector<Matrix> out;
  for (const auto& [time, direction] : kWithin)
    out.push_back(smooth_over(
        {{f.touch, stretch(f, time, 4)}, {as_points(f.normal_on_probe), direction}, {as_points(f.sensor), 0.7}},
        kMost));
  return out;
}

}  // namespace

void over_direction(const TouchFactors& f, Family& family) {
  const Points normal = as_points(f.normal);
  family.add("smooth", smooth(normal, 0.6, 40));
  family.add("in time", products(smooth(normal, 0.9, 8), smooth(f.time, 0.2, 8)));
  family.add("over position", products(smooth(normal, 0.9, 8), linear(f.place)));
  family.add("of the touch before", after_the_touch_before(f));
  family.add_any("sides of tips in time", sides_of_tips(f));
  if (f.oblique) {
    family.add("of travel", smooth(as_points(f.travel), 0.6, 40));
    family.add("of oblique approaches", skidding(f));
  }
  if (several(f.orientation)) {
    family.add("on the probe", smooth(as_points(f.normal_on_probe), 0.6, 40));
    family.add("lobes", lobes_of_the_probe(f));
  }
}

}  // namespace abbe::diagnose::patterns
