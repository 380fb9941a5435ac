// Where a machine touches a feature when the program gives no points: MEAS without PTMEAS, the AUTO of
// MODE (ISO 22093). The standard leaves the pattern to the machine; these are even, plain ones, so that
// the uncertainty is that of a sensible operator.
//
// Everything is laid out in the frame in which the nominal was defined. Angles about an axis count from
// the direction of that frame's x axis across it (y when the axis runs along x). Planes and unbounded
// lines have no extent in their nominal: they are touched within 10 mm of its point, which fits on most
// faces; give PTMEAS for more. Collisions are not looked for.
#pragma once

#include <string_view>

#include "engine/base/arguments.hpp"
#include "engine/features/element.hpp"

namespace abbe {

inline constexpr double kPatternReach_mm = 10;  ///< to every side of a nominal point without extent
inline constexpr int kMostPatternTouches = 10'000;

struct PatternTouch {
  Vec3 point, normal;  ///< on the nominal surface, out of the material; frame of the nominal
};

/// Touch `index` (from 0) of `count`. Fails for kinds without a pattern.
Outcome<PatternTouch> pattern_touch(Shape, const Element& nominal, bool inner, int index, int count);

/// The fewest touches with which a pattern determines its feature: those that the kind needs, but six for a
/// cylinder, because five points lie on several cylinders.
int pattern_minimum(Shape);

/// One line for people: where the touches lie. Empty when the kind has no pattern.
std::string_view pattern_help(Shape);

}  // namespace abbe
