#include "engine/diagnose/model/rotated.hpp"

#include <doctest/doctest.h>

#include "tests/unit/diagnose/random_model.hpp"

using namespace abbe;
using namespace abbe::diagnose;

TEST_CASE("the squares are those of uncorrelated units") {
  const LinearModel m = model_of(50, 1, 1, 0, 2);
  Hyperparameters h;
  h.noise = Vector::Ones(1);
  const Rotated r(m, h);
  CHECK(r.squares() == doctest::Approx(m.y.dot(dense_precision(m, h) * m.y)).epsilon(1e-8));
  CHECK(r.dof() == 50 - m.free.cols());
}
