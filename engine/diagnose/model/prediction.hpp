// What all other rows of a recording say of each: their prediction of it, and what of a row is noise.
#pragma once

#include "engine/diagnose/model/linear.hpp"

namespace abbe::diagnose {

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
/// The same from the precision of whitened rows.
Matrix squared_correlation(const Matrix& precision);

/// How far each of the `masked` rows is from what those that are not predict, um; 0 for the others.
Vector beyond_prediction(LinearModel, const Hyperparameters&, const std::vector<char>& masked);

}  // namespace abbe::diagnose
