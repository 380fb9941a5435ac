// A linear model with random columns, and its inverse covariance by definition.
#pragma once

#include <cmath>

#include "engine/diagnose/model/linear.hpp"
#include "engine/lanes/random.hpp"

namespace abbe::diagnose {

inline double drawn(std::uint32_t address) {
  return normal_quantile(uniform_pair({7, address, stream_of("linear_test"), 0, 0, 0}).a);
}

inline Matrix random_matrix(int rows, int columns, std::uint32_t stream) {
  Matrix m(rows, columns);
  for (int i = 0; i < rows; ++i)
    for (int k = 0; k < columns; ++k) m(i, k) = drawn(stream + static_cast<std::uint32_t>(1000 * i + k));
  return m;
}

inline LinearModel model_of(int rows, double scale, double noise, double phi, std::uint32_t stream) {
  LinearModel m;
  m.free = random_matrix(rows, 3, stream + 1'000'000);
  m.random = 2 * random_matrix(rows, 12, stream + 2'000'000);
  m.random_group.assign(12, 0);
  m.noise_um = Vector::Constant(rows, 0.5);
  m.noise_group.assign(static_cast<std::size_t>(rows), 0);
  m.follows.assign(static_cast<std::size_t>(rows), 1);
  m.follows[0] = 0;
  Vector e(rows), u(12);
  for (int k = 0; k < 12; ++k) u(k) = scale * drawn(stream + 3'000'000 + static_cast<std::uint32_t>(k));
  for (int i = 0; i < rows; ++i) {
    const double white = drawn(stream + 4'000'000 + static_cast<std::uint32_t>(i));
    e(i) = i == 0 ? white : phi * e(i - 1) + std::sqrt(1 - phi * phi) * white;
  }
  m.y = m.free * Vector::Constant(3, 40.0) + m.random * u + 0.5 * noise * e;
  return m;
}

/// The inverse of a covariance with the columns x projected out, dense and by definition.
inline Matrix inverse_beside(const Matrix& x, const Matrix& covariance) {
  const Matrix inverse = Cholesky(covariance).inverse(), weighted = inverse * x;
  return inverse - weighted * Cholesky(x.transpose() * weighted).inverse() * weighted.transpose();
}

inline Matrix dense_precision(const LinearModel& m, const Hyperparameters& h, const Matrix& noise) {
  return inverse_beside(m.free, h.scale * h.scale * m.random * m.random.transpose() + noise);
}

inline Matrix dense_precision(const LinearModel& m, const Hyperparameters& h) {
  Vector variance(m.y.size());
  for (Eigen::Index i = 0; i < variance.size(); ++i)
    variance(i) = std::pow(m.noise_um(i) * h.noise(m.noise_group[static_cast<std::size_t>(i)]), 2);
  return dense_precision(m, h, Matrix(variance.asDiagonal()));
}

}  // namespace abbe::diagnose
