#include "engine/features/pattern.hpp"

#include <algorithm>
#include <cmath>

namespace abbe {

Outcome<PatternTouch> pattern_touch(const FeatureKind& kind, const Element& nominal, bool inner, int index, int count) {
  if (!kind.pattern.touch)
    return Outcome<PatternTouch>::failed("its nominal does not say where its surface begins and ends");
  Outcome<PatternTouch> touch = kind.pattern.touch(nominal, inner, index, count);
  if (inner) touch.value.normal = -touch.value.normal;
  return touch;
}

int pattern_minimum(const FeatureKind& kind) { return std::max(kind.minimum_points, kind.pattern.minimum); }

Across::Across(const Vec3& n) {
  const Vec3 x = perpendicular_part({1, 0, 0}, n);
  a = unit(norm(x) > 0.5 ? x : perpendicular_part({0, 1, 0}, n));
  b = cross(n, a);
}

Vec3 Across::at(double angle_rad) const { return std::cos(angle_rad) * a + std::sin(angle_rad) * b; }

double spread_evenly(int k, int n) { return n > 1 ? 2.0 * k / (n - 1) - 1 : 0; }

PatternGrid::PatternGrid(int index, int count) {
  const int columns = std::max(1, static_cast<int>(std::ceil(std::sqrt(count)))),
            rows = (count + columns - 1) / columns;
  const int row = index / columns, in_row = std::min(columns, count - row * columns);
  a = kPatternReach_mm * spread_evenly(index % columns, in_row), b = kPatternReach_mm * spread_evenly(row, rows);
}

}  // namespace abbe
