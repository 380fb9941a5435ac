// Where a touch was made, as far as touches can be told to repeat one another.
#pragma once

#include <array>
#include <cmath>

#include "engine/effects/effect.hpp"

namespace abbe::diagnose {

/// Alike for touches of one setup with one tip at the same point and along the same normal: to a micrometre, and to a tenth
/// of a milliradian.
using Place = std::array<long, 8>;
inline Place place_of(const TouchScene& s) {
  constexpr double kPerMm = 1e3, kPerUnit = 1e4;
  Place place{s.setup, s.stylus.tip_ordinal};
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    place[2 + a] = std::lround(kPerMm * s.point[axis]), place[5 + a] = std::lround(kPerUnit * s.normal[axis]);
  }
  return place;
}

}  // namespace abbe::diagnose
