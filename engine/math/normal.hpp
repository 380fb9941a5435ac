// The normal law.
#pragma once

#include <cmath>

namespace abbe {

/// So many standard deviations either way hold 95 %.
inline constexpr double kNormal95 = 1.96;

/// The probability that a standard normal number is less than z.
inline double normal_below(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

}  // namespace abbe
