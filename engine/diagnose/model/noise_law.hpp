// How heavy the tails of the noise are. A probe that now and then triggers early has more far touches than a
// normal law; a search that simulates normal noise takes a few of them in one place for a pattern.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/diagnose/model/linear.hpp"

namespace abbe::diagnose {

/// Standard deviations, predicted from all other touches, beyond which a touch is a gross outlier: one in 40 000
/// normal ones.
inline constexpr double kOutlier = 4.2;

/// What is believed of the law of a touch's noise: normal, or Student's t of unit variance.
class NoiseLaw {
 public:
  /// Normal beyond doubt.
  NoiseLaw() = default;
  /// As standardised residuals tell, of any common scale.
  explicit NoiseLaw(const Vector& standardised);
  /// Student's t of these degrees of freedom beyond doubt.
  static NoiseLaw student_t(double dof);

  double belief_in_normal() const { return normal_; }

  /// Independent numbers of one of these laws, drawn by belief, and cut off where touches are gross outliers.
  Vector simulated(Eigen::Index count, std::uint64_t seed, std::uint32_t stream, int replicate) const;

 private:
  double normal_ = 1;
  std::vector<std::pair<double, double>> student_;  ///< degrees of freedom, and the belief in them
};

/// The probability of so many or more where so many are expected, each by chance.
double poisson_tail(double count, double expected);

/// Independent standard normal numbers.
Vector standard_normal(Eigen::Index count, std::uint64_t seed, std::uint32_t stream, int replicate);

}  // namespace abbe::diagnose
