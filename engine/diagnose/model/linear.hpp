// The linear-Gaussian model of a recording, and what every step of the diagnosis asks of it.
//
//     y = X b + Z u + e,      u ~ N(0, scale_g^2 1) by group,      e ~ N(0, D) with a common correlation phi of neighbours
//
// y: residuals, um. X: what nothing is known of (placement of the part, unknown sizes). Z: what the simulated
// ensemble may do, scaled so that one unit is one standard deviation of the ensemble. Hyperparameters (scale
// of a group of Z, factor on the noise of a group of rows, phi) are estimated by restricted maximum
// likelihood with weak priors about 1, because a wrong prior of the baseline is the greatest source of false
// alarms. All rows are whitened with them and X is projected out; then one eigen-decomposition of Z Z' makes
// every later evaluation, for another scale and another noise, cost one pass over the rows:
//
//     z = U' y ~ N(0, g^2 lambda + s^2),       rest = y - U z ~ N(0, s^2 (1 - U U'))
//
// Sources: Patterson & Thompson, Biometrika 58 (1971), restricted likelihood; Rasmussen & Williams, Gaussian
// Processes for Machine Learning, 2.7 and 5.4.1 (evidence with linear terms of infinite prior variance).
#pragma once

#include <Eigen/Core>
#include <span>
#include <utility>
#include <vector>

#include "engine/math/units.hpp"

namespace abbe::diagnose {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Of residuals in um.
struct LinearModel {
  Vector y;                       ///< um
  Matrix free;                    ///< X, one column per unknown of which nothing is known
  Matrix random;                  ///< Z, um per standard deviation
  std::vector<int> random_group;  ///< by column of Z; 0 is the group whose scale is estimated, the others keep theirs
  Matrix rough;  ///< another ensemble in the place of group 0: no columns when there is none (rough_geometry.hpp)
  /// one error function, or all of an axis, that are more uneven than the others: no physics left out (rough_geometry.hpp)
  std::vector<Matrix> uneven;
  Vector noise_um;               ///< standard deviation of a row as the machine file states it
  std::vector<int> noise_group;  ///< by row
  int noise_groups = 1;
  /// of group 0 that is believed: whatever asks for more is no machine of this specification, or not the
  /// known one
  double largest_scale = 2.5;
  /// of the logarithm of the scale of group 0: how far a machine's errors may be from the specification's
  double scale_spread = 0.5;
  /// least factor on noise_um: no probe is so much better than its specification
  double quietest = 0.05;
  std::vector<char> follows;  ///< by row: measured right after the row before, with the same stylus
};

struct Hyperparameters {
  double scale = 1;        ///< of group 0 of Z
  Vector noise;            ///< factor on noise_um, by noise group
  double correlation = 0;  ///< phi of neighbouring rows
};

/// Restricted maximum likelihood with log-normal priors about 1 (sd scale_spread for the scale, 0.5 for the noise).
Hyperparameters estimate(const LinearModel&);

/// The same without a correlation of neighbours.
Hyperparameters estimate_uncorrelated(const LinearModel&);

/// Logarithm of what whitening with this noise and taking out X do to the density of a recording: what sets
/// models of other noise apart.
double log_density(const LinearModel&, const Hyperparameters&);

/// By row: whether the others say nothing of it, because an unknown of its own takes it up, as that of a surface point
/// that was touched once does.
std::vector<char> alone(const LinearModel&);

/// Standardised residual of each row, predicted from all other rows: of the touch itself, where neighbours
/// have noise in common too.
Vector leave_one_out(const LinearModel&, const Hyperparameters&);

/// The noise of each row as all rows tell it: its expectation given the recording, um. What is left of a
/// row's noise beside it has nothing to do with the recording.
Vector expected_noise(const LinearModel&, const Hyperparameters&);

/// The inverse covariance K of the touches, free of what X can do: (K y)_i / sqrt(K_ii) are these residuals.
Matrix precision(const LinearModel&, const Hyperparameters&);

/// Squares of the correlations of these residuals, by pair of rows, when the model is right.
Matrix squared_correlation(const LinearModel&, const Hyperparameters&);

/// Columns of Z that are of group 0, whose scale is estimated, or those that are not.
std::vector<Eigen::Index> columns_of_group(const LinearModel&, bool scaled);

/// Orthonormal U and lambda > 0 with Z Z' = U diag(lambda) U', but for what is negligible beside a noise of 1. An axis is positive
/// where it is largest: else the last digit would decide.
std::pair<Matrix, Vector> principal_axes(const Matrix& z);

/// The same model without the combinations of group 0 of Z, and of the other ensemble, that stay far below the noise.
LinearModel compact(const LinearModel&);

/// The model whose group 0 of Z is the other ensemble.
LinearModel rougher(const LinearModel&);

/// The model with these columns, um per standard deviation, beside its ensemble, at the size that they have.
LinearModel with_random(const LinearModel&, const Matrix& columns);

/// The columns of all of them, which have so many rows, one after the other.
Matrix side_by_side(Eigen::Index rows, std::span<const Matrix* const>);

/// Orthonormal columns that span the same space: touches of few directions leave parts of a placement open.
Matrix independent(const Matrix& columns);

/// What of this displacement of the rows, um, shows beside all that X can do.
Vector beside_free(const LinearModel&, const Vector&);

/// The model without some rows.
LinearModel without_rows(const LinearModel&, const std::vector<char>& dropped);

/// How far each of the `masked` rows is from what those that are not predict, um; 0 for the others.
Vector beyond_prediction(LinearModel, const Hyperparameters&, const std::vector<char>& masked);

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

/// The precision of a recording, the inverse of its covariance with X projected out, as an inner product of
/// columns. With the projected Z and L L' = 1 + Z'Z it is a'P b = a'b - (L^-1 Z'a)'(L^-1 Z'b): no
/// eigen-decomposition, so the cheaper way when scale and noise stay as they are.
class Precision {
 public:
  Precision(const LinearModel&, const Hyperparameters&);

  /// Columns as it sees them.
  struct Seen {
    Matrix rows, taken;  ///< projected; and what of them the ensemble can do

    Seen operator*(const Matrix& coefficients) const { return {rows * coefficients, taken * coefficients}; }
  };
  Seen seen(const Matrix& patterns) const;
  Seen y() const;

 private:
  Seen with_taken(Matrix rows) const;

  Projection project_;
  Matrix reach_;  ///< L^-1 Z'
  Vector y_;
};
/// a'P b.
Matrix inner(const Precision::Seen& a, const Precision::Seen& b);

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
  Matrix coordinates(const Matrix& projected) const { return basis_.transpose() * projected; }
  /// What of projected columns the ensemble cannot do.
  Matrix remainder(const Matrix& projected, const Matrix& coordinates) const {
    return projected - basis_ * coordinates;
  }
  const Vector& y() const { return y_; }  ///< projected
  Vector z() const { return basis_.transpose() * y_; }
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

/// The model with the signatures of some variants as unknowns without a prior.
LinearModel with_free(const LinearModel&, const std::vector<const Matrix*>& signatures);

}  // namespace abbe::diagnose
