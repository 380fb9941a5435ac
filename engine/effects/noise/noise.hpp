// The effects that change the noise (docs/physics/noise.md), one per .cpp file. They shift no mean:
// their numbers are drawn anew for every touch, and a diagnosis judges them by the likelihood of
// the spread, not by added terms.
#pragma once

#include "engine/effects/terms.hpp"

namespace abbe {

extern const Effect kVibration;
extern const Effect kOutliers;
extern const Effect kResolution;
extern const Effect kUnequalNoise;

/// Standard deviation of the logarithm of an outlier's size (noise.outliers): 12 um exp(+-1.96 * 0.7) is 3 to 47 um.
inline constexpr double kOutlierLogSpread = 0.7;

/// Heads that are tilted by more count as tilted (noise.unequal).
inline constexpr double kUpright_rad = 1 * kDegree;
/// Whether the head has these angles, to a degree.
inline bool same_orientation(const StylusScene& s, double a_rad, double b_rad) {
  return std::fabs(std::remainder(s.head_a_rad - a_rad, 2 * kPi)) < kUpright_rad &&
      std::fabs(std::remainder(s.head_b_rad - b_rad, 2 * kPi)) < kUpright_rad;
}

}  // namespace abbe
