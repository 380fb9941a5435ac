// Rows whitened by the noise of a model, and free of what X can do.
#pragma once

#include "engine/diagnose/model/linear.hpp"

namespace abbe::diagnose {

/// 1 / standard deviation of the noise, by row.
Vector weights(const LinearModel&, const Hyperparameters&);

/// Rows times their weights, then differenced where neighbours have a correlation `phi`, so that they are independent again.
Matrix whitened(const Matrix& columns, const Vector& weight, double phi, const std::vector<char>& follows);

/// Logarithm of what whitening with this noise and taking out X do to the density of a recording: what sets
/// models of other noise apart.
double log_density(const LinearModel&, const Hyperparameters&);

/// Rows whitened by the noise of a model and free of what X can do.
class Projection {
 public:
  Projection(const LinearModel&, const Hyperparameters&);

  Matrix operator()(const Matrix& columns) const;
  /// The same of patterns, of any size: those that X can do but for the last digits are zero.
  Matrix of_patterns(const Matrix& columns) const;
  /// A row vector whose projection is this one.
  Vector unwhitened(const Vector& projected) const;
  /// From whitened rows back to the touches, whose noise is 1 but may have something in common: the transpose
  /// of taking neighbours' differences.
  Matrix of_touches(const Matrix& whitened) const;
  /// The inverse covariance of that noise: its diagonal, and what is beside it.
  std::pair<Vector, Vector> noise_precision() const;
  /// Orthonormal basis of the whitened X.
  const Matrix& free() const { return q_; }

 private:
  std::vector<char> follows_;
  Vector weight_;  ///< 1 / sd by row
  double correlation_ = 0;
  Matrix q_;
};

}  // namespace abbe::diagnose
