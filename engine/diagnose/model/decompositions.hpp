// Decompositions of dense matrices, those of Eigen: each is a large template, which is compiled once here and not
// again in every file that needs it.
#pragma once

#include <Eigen/Core>

namespace abbe::diagnose {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// S = V diag(values) V', V' V = 1, of a symmetric matrix S.
struct Spectrum {
  Vector values;   ///< ascending
  Matrix vectors;  ///< V, a column each
};

/// Reads the lower triangle.
Spectrum spectrum(const Matrix& symmetric);

/// S = Q T Q', Q' Q = 1, of a symmetric matrix S, where T has three diagonals.
struct Tridiagonal {
  Vector diagonal;
  Vector beside;  ///< one less
  Matrix axes;    ///< Q, a column each
};

/// Reads the lower triangle. A third of the work of a spectrum.
Tridiagonal tridiagonal(const Matrix& symmetric);

/// S v = value P v, V' P V = 1, of a symmetric matrix S beside a positive definite one, P.
Spectrum spectrum_beside(const Matrix& symmetric, const Matrix& positive);

/// The symmetric P^-1/2 of a positive definite matrix P.
Matrix inverse_root(const Matrix& positive);

/// F with F F' = S of a symmetric matrix S that is not negative, but may be singular.
Matrix factor_of(const Matrix& symmetric);

/// A factor with the same F F' that has no more columns than rows.
Matrix no_wider(const Matrix& factor);

/// P + a 1 = L L' of a positive definite matrix, L lower triangular; InternalError where it is none.
class Cholesky {
 public:
  explicit Cholesky(Matrix p, double a = 0);
  /// (P + a 1)^-1 b.
  Matrix solve(const Matrix& b) const;
  Vector solve(const Vector& b) const;
  Matrix inverse() const;
  /// L^-1 b: columns of this covariance in units in which they are uncorrelated, each of variance 1.
  Matrix whitened(const Matrix& b) const;
  Vector whitened(const Vector& b) const;
  /// 1/2 log |P + a 1|.
  double half_log_determinant() const;
  const Matrix& lower() const { return lower_; }

 private:
  Matrix lower_;
};

/// The x, of all that make |A x - b| least the shortest.
Matrix least_squares(const Matrix& a, const Matrix& b);
Vector least_squares(const Matrix& a, const Vector& b);

/// By column of `cross`, A' b: the squared length of what columns A explain of b, whose inner products are `gram`, A' A.
/// Columns that tell nothing, or the same as others, explain nothing more.
Vector explained(const Matrix& gram, const Matrix& cross);

/// The inverse of a symmetric matrix in the space that it spans.
Matrix pseudo_inverse(const Matrix& symmetric);

/// Orthonormal columns that span the same space, where a column is no column that has less than 1e-6 of its own length
/// beside the others: touches of few directions leave parts of a placement open.
Matrix independent(const Matrix& columns);

}  // namespace abbe::diagnose
