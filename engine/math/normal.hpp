// The normal law, and what follows from it.
#pragma once

#include <cmath>

namespace abbe {

/// So many standard deviations either way hold 95 %.
inline constexpr double kNormal95 = 1.96;

/// The probability that a standard normal number is less than z.
inline double normal_below(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

/// The probability that chi-squared of n degrees of freedom exceeds x (Wilson & Hilferty 1931).
inline double chi2_above(double x, double n) {
  const double z = (std::cbrt(x / n) - (1 - 2 / (9 * n))) / std::sqrt(2 / (9 * n));
  return normal_below(-z);
}

}  // namespace abbe
