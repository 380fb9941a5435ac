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

  int rows() const { return static_cast<int>(y_.size()); }
  int rank() const { return static_cast<int>(lambda_.size()); }
  int rest_dof() const { return rest_dof_; }
  const Vector& lambda() const { return lambda_; }
  /// Columns of the recording's rows, whitened and free of X.
  Matrix project(const Matrix& columns) const { return project_(columns); }
  /// U' of projected columns.
  Matrix coordinates(const Matrix& projected) const;
  /// What of projected columns the ensemble cannot do.
  Matrix remainder(const Matrix& projected, const Matrix& coordinates) const;
  const Vector& y() const { return y_; }  ///< projected
  Vector z() const;
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
  Matrix taken_of_touches() const;  ///< T: that inverse covariance is the noise's minus T T'

  Projection project_;
  Matrix basis_;  ///< U
  Vector lambda_, y_;
  int rest_dof_ = 0;
};

}  // namespace abbe::diagnose
