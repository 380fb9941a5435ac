// Where a machine touches a feature when the program gives no points: MEAS without PTMEAS, the AUTO of
// MODE (ISO 22093). The standard leaves the pattern to the machine; these are even, plain ones, so that
// the uncertainty is that of a sensible operator.
//
// Everything is laid out in the frame in which the nominal was defined. Angles about an axis count from
// the direction of that frame's x axis across it (y when the axis runs along x). Planes and unbounded
// lines have no extent in their nominal: they are touched within 10 mm of its point, which fits on most
// faces; give PTMEAS for more. Collisions are not looked for.
#pragma once

#include "engine/features/feature.hpp"

namespace abbe {

inline constexpr double kPatternReach_mm = 10;  ///< to every side of a nominal point without extent
inline constexpr int kMostPatternTouches = 10'000;

/// Touch `index` (from 0) of `count`. Fails where FeatureKind::pattern does, and for kinds without one.
Outcome<PatternTouch> pattern_touch(const FeatureKind&, const Element& nominal, bool inner, int index, int count);

/// The fewest touches with which a pattern determines its feature.
int pattern_minimum(const FeatureKind&);

/// Two directions across the unit vector n: that of x (of y when n runs along x), and the next.
struct Across {
  Vec3 a, b;
  explicit Across(const Vec3& n);
  Vec3 at(double angle_rad) const;
};

/// Step k of n equal steps from -1 to 1; a single one is in the middle.
double spread_evenly(int k, int n);

/// Row by row over a square of as many columns as rows, or one more: mm from its middle.
struct PatternGrid {
  double a, b;
  PatternGrid(int index, int count);
};

/// Of points.
inline constexpr Pattern kAtThePoint{.help = "every touch at the point",
                                     .touch = [](const Element& e, bool, int, int) -> Outcome<PatternTouch> {
                                       return {{e.point, e.direction}};
                                     }};

}  // namespace abbe
