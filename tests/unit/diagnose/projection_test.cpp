#include "engine/diagnose/model/projection.hpp"

#include <doctest/doctest.h>
#include <cmath>

#include "engine/diagnose/model/ensemble_basis.hpp"
#include "tests/unit/diagnose/random_model.hpp"

using namespace abbe;
using namespace abbe::diagnose;

TEST_CASE("densities under two noises compare as by the dense formula") {
  LinearModel m = model_of(60, 1, 1, 0.5, 11);
  m.follows[30] = 0;
  const Eigen::Index n = m.y.size();
  const auto dense = [&](const Hyperparameters& h) {
    Matrix v = Matrix::Zero(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j)
        if ((i < 30) == (j < 30))
          v(i, j) = std::pow(0.5 * h.noise(0), 2) * std::pow(h.correlation, std::abs(double(i - j)));
    v += h.scale * h.scale * m.random * m.random.transpose();
    const Matrix inverse = Cholesky(v).inverse(), of_free = m.free.transpose() * inverse * m.free;
    return -Cholesky(v).half_log_determinant() - Cholesky(of_free).half_log_determinant() -
        0.5 * m.y.dot(inverse_beside(m.free, v) * m.y);
  };
  const auto diagonal = [&](const Hyperparameters& h) {
    const EnsembleBasis basis(m, h);
    const Vector y = basis.project(m.y), z = basis.coordinates(y),
                 variance = 1 + h.scale * h.scale * basis.lambda().array();
    return log_density(m, h) -
        0.5 *
        (variance.array().log().sum() + (z.array().square() / variance.array()).sum() +
         basis.remainder(y, z).squaredNorm());
  };
  Hyperparameters correlated, white;
  correlated.noise = Vector::Constant(1, 0.8), correlated.correlation = 0.45, correlated.scale = 1.2;
  white.noise = Vector::Constant(1, 1.1);
  CHECK(diagonal(correlated) - diagonal(white) == doctest::Approx(dense(correlated) - dense(white)).epsilon(1e-9));
}
