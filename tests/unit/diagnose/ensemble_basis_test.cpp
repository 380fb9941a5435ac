#include "engine/diagnose/model/ensemble_basis.hpp"

#include <doctest/doctest.h>

#include "engine/diagnose/model/projection.hpp"
#include "engine/lanes/random.hpp"
#include "engine/math/normal.hpp"
#include "tests/unit/diagnose/random_model.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

constexpr int kTouches = 50;

Matrix normal_numbers(int columns, std::uint32_t which) {
  Matrix out(kTouches, columns);
  for (int i = 0; i < kTouches; ++i)
    for (int k = 0; k < columns; ++k)
      out(i, k) = normal_quantile(
          uniform_pair({7, static_cast<std::uint32_t>(kTouches * k + i), stream_of("ensemble_basis_test"), which, 0, 0})
              .a);
  return out;
}

/// Three unknowns, four columns that are scaled and two that are not, noise of 0.5 um.
LinearModel random_model() {
  LinearModel m;
  m.free = normal_numbers(3, 1);
  m.random = normal_numbers(6, 2);
  m.random_group = {0, 1, 0, 0, 1, 0};
  m.noise_um = Vector::Constant(kTouches, 0.5);
  m.noise_group.assign(kTouches, 0);
  m.follows.assign(kTouches, 1);
  m.y = normal_numbers(1, 3);
  return m;
}

Hyperparameters correlated_noise() {
  Hyperparameters h;
  h.noise = Vector::Constant(1, 0.8), h.correlation = 0.6;
  return h;
}

}  // namespace

TEST_CASE("inner products at every scale are those of the covariance in which some columns keep their scale") {
  const LinearModel m = random_model();
  const Hyperparameters h = correlated_noise();
  const EnsembleBasis basis(m, h);
  CHECK(basis.kept_count() == 2);
  CHECK(basis.rank() == 4);
  CHECK(basis.rest_dof() == kTouches - 3 - 4);
  const Matrix a = normal_numbers(4, 4), projected = basis.project(a), z = basis.coordinates(projected),
               rest = basis.remainder(projected, z);
  for (const double g : {0.4, 1.0, 2.5}) {
    Matrix v(kTouches, kTouches);
    for (int i = 0; i < kTouches; ++i)
      for (int j = 0; j < kTouches; ++j) v(i, j) = std::pow(0.4, 2) * std::pow(0.6, std::abs(i - j));
    for (int k = 0; k < 6; ++k)
      v += (m.random_group[k] == 0 ? g * g : 1) * m.random.col(k) * m.random.col(k).transpose();
    const Matrix precision = inverse_beside(m.free, v);
    const Vector weight = (1 + g * g * basis.lambda().array()).inverse();
    const Matrix got = z.transpose() * weight.asDiagonal() * z + rest.transpose() * rest,
                 expected = a.transpose() * precision * a;
    CHECK((got - expected).cwiseAbs().maxCoeff() < 1e-8 * expected.cwiseAbs().maxCoeff());
  }
}

TEST_CASE("a recording made of numbers has them") {
  const LinearModel m = random_model();
  const EnsembleBasis basis(m, correlated_noise());
  const Vector coordinates = normal_numbers(1, 5).topRows(4);
  const Matrix of_ensemble = basis.project(basis.recording(coordinates, Vector::Zero(2), Vector::Zero(kTouches)));
  CHECK((basis.coordinates(of_ensemble) - coordinates).norm() < 1e-9);
  CHECK(basis.remainder(of_ensemble, coordinates).norm() < 1e-9);
}

TEST_CASE("each column that keeps its scale has a number, by the row from which on it acts") {
  LinearModel m = random_model();
  m.random.col(1).head(25).setZero();
  LinearModel other = m;
  other.random.col(1).swap(other.random.col(4));
  const Projection project(m, correlated_noise());
  for (const LinearModel& model : {m, other}) {
    const EnsembleBasis basis(model, correlated_noise());
    for (int k = 0; k < 2; ++k) {
      const Matrix column = project(m.random.col(k == 0 ? 4 : 1)),
                   kept = project(basis.recording(Vector::Zero(4), Vector::Unit(2, k), Vector::Zero(kTouches)));
      CHECK((kept - column).norm() < 1e-9 * column.norm());
    }
  }
}

TEST_CASE("what an unknown does whatever its unit is nothing") {
  LinearModel m = random_model();
  m.free.col(0) *= 1e9;
  m.free.col(2) *= 1e-9;
  Hyperparameters h;
  h.noise = Vector::Ones(1);
  m.random_group.assign(6, 0);  // whitening by columns that keep their scale makes patterns smaller
  const Matrix a = normal_numbers(1, 6), column = 3e-9 * m.free.col(0) + m.free.col(1) - 1e9 * m.free.col(2) + 1e-5 * a;
  const EnsembleBasis basis(m, h);
  CHECK(basis.project_patterns(column).isZero(0));
  CHECK(basis.project_patterns(m.free).isZero(0));
  CHECK((basis.project_patterns(a) - basis.project(a)).isZero(0));
  CHECK(basis.project(a).norm() > 0.9 * a.norm() / 0.5);
}
