#include "engine/diagnose/model/precision.hpp"

#include <doctest/doctest.h>

#include "engine/diagnose/model/prediction.hpp"
#include "tests/unit/diagnose/random_model.hpp"

using namespace abbe;
using namespace abbe::diagnose;

TEST_CASE("the precision as an inner product is that of the dense formula") {
  const LinearModel m = model_of(50, 1, 1, 0, 2);
  Hyperparameters h;
  h.scale = 1.3;
  h.noise = Vector::Constant(1, 0.8);
  const Precision precision(m, h);
  const Matrix a = random_matrix(50, 4, 900), dense = dense_precision(m, h), expected = a.transpose() * dense * a;
  CHECK((inner(precision.seen(a), precision.seen(a)) - expected).cwiseAbs().maxCoeff() <
        1e-8 * expected.cwiseAbs().maxCoeff());
  CHECK((inner(precision.seen(a), precision.y()) - a.transpose() * dense * m.y).cwiseAbs().maxCoeff() <
        1e-8 * (a.transpose() * dense * m.y).cwiseAbs().maxCoeff());
}
