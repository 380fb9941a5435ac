#include "engine/diagnose/model/prediction.hpp"

#include <doctest/doctest.h>
#include <cmath>

#include "engine/diagnose/model/restricted_likelihood.hpp"
#include "tests/unit/diagnose/random_model.hpp"

using namespace abbe;
using namespace abbe::diagnose;

TEST_CASE("residuals predicted from all other rows are those of the dense formula") {
  const LinearModel m = model_of(60, 1, 1, 0, 1);
  Hyperparameters h;
  h.scale = 1.3;
  h.noise = Vector::Constant(1, 0.8);
  const Matrix p = dense_precision(m, h);
  const Vector py = p * m.y, loo = leave_one_out(m, h);
  for (Eigen::Index i = 0; i < loo.size(); ++i)
    CHECK(loo(i) == doctest::Approx(py(i) / std::sqrt(p(i, i))).epsilon(1e-6));
  // cov(P y) = P, so the correlations of the residuals are those of P.
  const Matrix squared = squared_correlation(m, h);
  for (Eigen::Index i = 0; i < 60; ++i)
    for (Eigen::Index j = 0; j < 60; ++j)
      CHECK(squared(i, j) == doctest::Approx(p(i, j) * p(i, j) / (p(i, i) * p(j, j))).epsilon(1e-6));
}

TEST_CASE("the precision of the touches is that of the dense formula") {
  const LinearModel m = model_of(60, 1, 1, 0, 5);
  Hyperparameters h;
  h.scale = 1.3, h.noise = Vector::Constant(1, 0.8);
  CHECK((precision(m, h) - dense_precision(m, h)).cwiseAbs().maxCoeff() < 1e-8);
}

TEST_CASE("a touch is left out itself, not its difference from the touch before") {
  LinearModel m = model_of(60, 1, 1, 0.5, 21);
  m.follows[30] = 0;
  Hyperparameters h;
  h.noise = Vector::Constant(1, 0.8), h.correlation = 0.6;
  Matrix noise = Matrix::Zero(60, 60);
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j)
      if ((i < 30) == (j < 30)) noise(i, j) = std::pow(0.5 * 0.8, 2) * std::pow(0.6, std::abs(i - j));
  const Matrix p = dense_precision(m, h, noise);
  const Vector py = p * m.y, loo = leave_one_out(m, h), expected = noise * py, own = expected_noise(m, h);
  const Matrix squared = squared_correlation(m, h);
  for (Eigen::Index i = 0; i < 60; ++i) {
    CHECK(loo(i) == doctest::Approx(py(i) / std::sqrt(p(i, i))).epsilon(1e-6));
    CHECK(own(i) == doctest::Approx(expected(i)).epsilon(1e-6));  // E(e | y) = cov(e, y) P y
    for (Eigen::Index j = 0; j < 60; ++j)
      CHECK(std::sqrt(squared(i, j)) ==
            doctest::Approx(std::abs(p(i, j)) / std::sqrt(p(i, i) * p(j, j))).epsilon(1e-6));
  }
}

TEST_CASE("of one place touched again and again, the noise is all that differs") {
  LinearModel m = model_of(30, 1, 1, 0, 22);
  m.free = Matrix::Ones(30, 1);
  m.random = 3 * Matrix::Ones(30, 12);
  Hyperparameters h;
  h.noise = Vector::Constant(1, 1.3);
  const Vector rest = m.y - expected_noise(m, h);
  CHECK((rest.array() - rest.mean()).abs().maxCoeff() < 1e-9);
}

TEST_CASE("rows that are left out are as far off as they were moved, whatever their neighbours have in common") {
  LinearModel m = model_of(200, 1, 1, 0.5, 8);
  const Hyperparameters h = estimate(m);
  REQUIRE(h.correlation > 0);
  std::vector<char> masked(200, 0);
  const double before = beyond_prediction(m, h, [&] { return masked[40] = masked[41] = 1, masked; }())(40);
  CHECK(std::abs(before) < 4 * 0.5);
  m.y(40) += 30;
  const Vector off = beyond_prediction(m, h, masked);
  CHECK(off(40) - before == doctest::Approx(30).epsilon(1e-3));
  CHECK(off(39) == 0);
}
