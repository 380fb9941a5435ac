// A recording in the basis in which all that is random in its model is diagonal: with rows whitened and X projected out,
// one eigen-decomposition of Z Z' makes every later evaluation cost one pass over the rows:
//
//     z = U' y ~ N(0, lambda + 1),       rest = y - U z ~ N(0, 1 - U U')
//
// [Rasmussen & Williams, Gaussian Processes for Machine Learning, 2.7: linear terms of infinite prior variance]
#pragma once

#include "engine/diagnose/model/projection.hpp"

namespace abbe::diagnose {

/// Orthonormal U and lambda > 0 with Z Z' = U diag(lambda) U', but for what is negligible beside a noise of 1. An axis is positive
/// where it is largest: else the last digit would decide.
std::pair<Matrix, Vector> principal_axes(const Matrix& z);

/// A model in the basis in which all that is random in it is diagonal, noise apart, at the scale that it has.
class Rotated {
 public:
  Rotated(const LinearModel&, const Hyperparameters&);

  /// The squares of the recording in units in which it is uncorrelated, each of variance 1, and how many there are.
  double squares() const;
  int dof() const { return static_cast<int>(y_.size() - project_.free().cols()); }
  /// What of the projected rows is noise, as far as they tell.
  Vector noise_part() const;
  /// Row vectors of the touches: Projection::of_touches, and um.
  Vector of_touches(const Vector& white) const { return project_.of_touches(white); }
  Vector recording_of(const Vector& white) const { return project_.unwhitened(white); }
  /// Diagonal of the inverse covariance of the touches in units of their noise, X projected out.
  Vector precision_diagonal() const;
  /// The whole of it.
  Matrix precision() const;

 private:
  Vector z() const;
  /// What of the projected rows is beside these coordinates of the ensemble, one column.
  Matrix remainder(const Matrix& coordinates) const;
  Matrix taken_of_touches() const;  ///< T: that inverse covariance is the noise's minus T T'

  Projection project_;
  Vector y_;      ///< projected
  Matrix basis_;  ///< U
  Vector lambda_;
};

}  // namespace abbe::diagnose
