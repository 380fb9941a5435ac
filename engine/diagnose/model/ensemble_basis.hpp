// A recording in the basis in which the ensemble whose scale is judged is diagonal, whatever its scale g:
//
//     V_g = g^2 Z_0 Z_0' + Z_1 Z_1' + D
//
// Z_0: group 0 of the model's random columns; Z_1: those that keep their scale. Rows are whitened by the noise D and free
// of X (Projection), then whitened by Z_1 too; with B the whitened Z_0 and B B' = U lambda U', every scale costs one pass:
//
//     U' y ~ N(0, g^2 lambda + 1),       y - U U' y ~ N(0, 1 - U U')
#pragma once

#include "engine/diagnose/model/projection.hpp"

namespace abbe::diagnose {

class EnsembleBasis {
 public:
  /// At these factors on the noise, and this correlation; their scale is not used.
  EnsembleBasis(const LinearModel&, const Hyperparameters&);

  int rows() const { return static_cast<int>(basis_.rows()); }
  int rank() const { return static_cast<int>(lambda_.size()); }
  /// Degrees of freedom that neither X nor the ensemble takes.
  int rest_dof() const { return rest_dof_; }
  const Vector& lambda() const { return lambda_; }
  /// What both whitenings and taking out X do to the log density of a recording.
  double log_density() const { return log_density_; }

  /// Columns of the recording's rows, um, whitened and free of X.
  Matrix project(const Matrix& columns) const { return kept_.whitened(project_(columns)); }
  /// The same of patterns, of any size: those that X can do but for the last digits are zero.
  Matrix project_patterns(const Matrix& columns) const { return kept_.whitened(project_.of_patterns(columns)); }
  /// U' of projected columns.
  Matrix coordinates(const Matrix& projected) const;
  /// What of projected columns the ensemble cannot do.
  Matrix remainder(const Matrix& projected, const Matrix& coordinates) const;

  /// How many columns keep their scale: so many standard normal numbers they take in a recording, in their order, because
  /// axes of equal variance may turn with the last digit.
  int kept_count() const { return static_cast<int>(kept_columns_.cols()); }
  /// A recording, um, free of X, to which the ensemble contributes these coordinates, the columns that keep their scale
  /// these numbers, and noise this: one number for each row, in units of its standard deviation.
  Vector recording(const Vector& coordinates, const Vector& kept, const Vector& noise) const;

 private:
  /// The columns that keep their scale: 1 + F F' with orthonormal axes and F F' = axes diag(variance) axes'.
  struct Kept {
    Matrix axes;
    Vector variance;

    Matrix whitened(Matrix projected) const;
    Matrix unwhitened(Matrix white) const;
  };

  Projection project_;
  Matrix kept_columns_;  ///< F
  Kept kept_;
  Matrix basis_;  ///< U
  Vector lambda_;
  int rest_dof_ = 0;
  double log_density_ = 0;
};

}  // namespace abbe::diagnose
