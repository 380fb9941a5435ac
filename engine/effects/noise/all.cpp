// The list of the effects of the noise.
#include "engine/effects/families.hpp"
#include "engine/effects/noise/noise.hpp"

namespace abbe {

std::span<const Effect* const> noise_effects() {
  static constexpr const Effect* list[] = {&kVibration, &kOutliers, &kResolution, &kUnequalNoise};
  return list;
}

}  // namespace abbe
