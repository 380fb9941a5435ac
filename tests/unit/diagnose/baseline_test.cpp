#include "engine/diagnose/baseline/baseline.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/unit/diagnose/random_model.hpp"

using namespace abbe;
using namespace abbe::diagnose;

TEST_CASE("what is left of the geometry is that of touches whose neighbours have noise in common") {
  constexpr int kTouches = 40, kCoefficients = 3;
  const auto wave = [](double k, int i) { return std::cos(0.37 * k * i + k * k); };
  Baseline b;
  b.factor = Vector{{2.0, 0.5, 1.5}}.asDiagonal();
  b.mean = Vector{{1.0, -2.0, 0.5}};
  LinearModel& m = b.model;
  m.free = Matrix::Ones(kTouches, 1);
  m.random.resize(kTouches, kCoefficients + 1);
  m.y.resize(kTouches);
  for (int i = 0; i < kTouches; ++i) {
    m.y(i) = wave(11, i) + 0.1 * i;
    for (int k = 0; k <= kCoefficients; ++k) m.random(i, k) = wave(1 + k, i);
  }
  m.random_group = {0, 0, 0, 1};
  m.noise_um = Vector::Constant(kTouches, 0.5);
  m.noise_group.assign(kTouches, 0);
  m.follows.assign(kTouches, 1), m.follows[0] = m.follows[25] = 0;
  Hyperparameters h;
  h.noise = Vector::Constant(1, 1.2), h.correlation = 0.6, h.scale = 1.4;

  Matrix noise = Matrix::Zero(kTouches, kTouches);
  for (int i = 0; i < kTouches; ++i)
    for (int j = 0; j < kTouches; ++j)
      if ((i < 25) == (j < 25)) noise(i, j) = std::pow(0.5 * 1.2, 2) * std::pow(0.6, std::abs(i - j));
  Matrix prior = Matrix::Identity(kCoefficients + 1, kCoefficients + 1);
  prior.topLeftCorner(kCoefficients, kCoefficients) *= 1.4 * 1.4;
  const Matrix p = inverse_beside(m.free, m.random * prior * m.random.transpose() + noise);
  const Matrix gain = prior * m.random.transpose() * p;  // the law of what is known given the recording, X of no prior
  const Vector mean = b.mean + b.factor * (gain * m.y).head(kCoefficients);
  const Matrix covariance =
      b.factor * (prior - gain * m.random * prior).topLeftCorner(kCoefficients, kCoefficients) * b.factor.transpose();

  const auto is_it = [&](const KnownGeometry& known) {
    CHECK((known.mean - mean).cwiseAbs().maxCoeff() < 1e-9);
    CHECK((known.factor * known.factor.transpose() - covariance).cwiseAbs().maxCoeff() < 1e-9);
    CHECK(known.factor.cols() == kCoefficients);
  };
  is_it(posterior(b, h));

  // Rougher errors are told by what they are as harmonics, of which there are fewer: here each is made of two halves.
  const double half = std::sqrt(0.5);
  m.rough.resize(kTouches, 2 * kCoefficients);
  m.rough << half * m.random.leftCols(kCoefficients), half * m.random.leftCols(kCoefficients);
  b.rough_factor.resize(kCoefficients, 2 * kCoefficients);
  b.rough_factor << half * b.factor, half * b.factor;
  m.random.leftCols(kCoefficients).setConstant(99);  // of no account then
  is_it(posterior(b, h, Errors::rough));
}
