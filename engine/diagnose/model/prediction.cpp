#include "engine/diagnose/model/prediction.hpp"

#include <cmath>

#include "engine/diagnose/model/rotated.hpp"

namespace abbe::diagnose {

Vector leave_one_out(const LinearModel& m, const Hyperparameters& h) {
  const Rotated rotated(m, h);
  // With the inverse covariance K of the touches, X projected out, (K y)_i / K_ii is row i minus its
  // prediction from all others, 1 / K_ii the variance.
  const Vector ky = rotated.of_touches(rotated.noise_part()), diagonal = rotated.precision_diagonal();
  Vector out(m.y.size());
  for (Eigen::Index i = 0; i < out.size(); ++i) out(i) = diagonal(i) > 1e-9 ? ky(i) / std::sqrt(diagonal(i)) : 0;
  return out;
}

Vector expected_noise(const LinearModel& m, const Hyperparameters& h) {
  const Rotated rotated(m, h);
  return rotated.recording_of(rotated.noise_part());
}

Vector beyond_prediction(LinearModel m, const Hyperparameters& h, const std::vector<char>& masked) {
  // With a noise of its own so large that it tells nothing, and has nothing to do with that of its neighbours.
  constexpr double kTellsNothing = 1e4;
  for (std::size_t i = 0; i < masked.size(); ++i) {
    if (masked[i]) m.noise_um(static_cast<Eigen::Index>(i)) *= kTellsNothing;
    if (masked[i] || (i > 0 && masked[i - 1])) m.follows[i] = 0;
  }
  Vector out = leave_one_out(m, h);
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const auto row = static_cast<std::size_t>(i);
    out(i) *= masked[row] ? m.noise_um(i) * h.noise(m.noise_group[row]) : 0;
  }
  return out;
}

Matrix precision(const LinearModel& m, const Hyperparameters& h) {
  const Vector weight = weights(m, h);
  return weight.asDiagonal() * Rotated(m, h).precision() * weight.asDiagonal();
}

Matrix squared_correlation(const LinearModel& m, const Hyperparameters& h) {
  return squared_correlation(Rotated(m, h).precision());
}

Matrix squared_correlation(const Matrix& p) {
  const Vector variance = p.diagonal().cwiseMax(1e-9);
  return (p.array().square().colwise() / variance.array()).rowwise() / variance.transpose().array();
}

}  // namespace abbe::diagnose
