#include "engine/diagnose/model/rotated.hpp"

#include <doctest/doctest.h>

#include "tests/unit/diagnose/random_model.hpp"

using namespace abbe;
using namespace abbe::diagnose;

TEST_CASE("the rotated basis keeps inner products") {
  const LinearModel m = model_of(50, 1, 1, 0, 2);
  Hyperparameters h;
  h.noise = Vector::Ones(1);
  const Rotated r(m, h);
  const Matrix a = random_matrix(50, 4, 900), projected = r.project(a), z = r.coordinates(projected),
               rest = r.remainder(projected, z);
  const Vector weight = (1 + r.lambda().array()).inverse();
  const Matrix got = z.transpose() * weight.asDiagonal() * z + rest.transpose() * rest;
  const Matrix expected = a.transpose() * dense_precision(m, h) * a;
  CHECK((got - expected).cwiseAbs().maxCoeff() < 1e-8 * expected.cwiseAbs().maxCoeff());
}
