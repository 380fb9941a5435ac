// Which surfaces a stylus reaches: none that faces away from the head, where its shaft would have to come through the part.
#pragma once

#include <algorithm>

#include "engine/run/recorded/touch.hpp"

namespace abbe::diagnose {

/// How far a surface faces the head: from 1 where the stylus stands upright on it down to -1 where it would come through it.
inline double facing(const Vec3& normal, const StylusScene& stylus) { return dot(normal, stylus.to_head); }

/// Down to where surfaces are reached: as far as in this recording, and a little beyond what lies along the stylus.
inline double least_facing(const RecordedTouches& recorded) {
  constexpr double kAlong = -0.05;
  double least = kAlong;
  for (const RecordedTouch& t : recorded.touches) least = std::min(least, facing(t.scene.normal, t.scene.stylus));
  return least;
}

}  // namespace abbe::diagnose
