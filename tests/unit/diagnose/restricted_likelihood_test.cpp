#include "engine/diagnose/model/restricted_likelihood.hpp"

#include <doctest/doctest.h>
#include <cmath>

#include "engine/diagnose/model/precision.hpp"
#include "engine/diagnose/model/prediction.hpp"
#include "tests/unit/diagnose/random_model.hpp"

using namespace abbe;
using namespace abbe::diagnose;

TEST_CASE("scale, noise and correlation are found again") {
  // 2 sd of the estimates: 1/sqrt(2 * 12) of the scale, 1/sqrt(2 * 400) of the noise.
  const Hyperparameters h = estimate(model_of(400, 2, 1.4, 0, 3));
  CHECK(std::abs(std::log(h.scale / 2)) < 0.5);
  CHECK(h.noise(0) == doctest::Approx(1.4).epsilon(0.08));
  CHECK(h.correlation == 0);
  const Hyperparameters correlated = estimate(model_of(400, 1, 1, 0.5, 4));
  CHECK(correlated.correlation > 0.25);
  CHECK(correlated.correlation < 0.75);
}

TEST_CASE("unknowns that the rows do not determine do no harm") {
  LinearModel m = model_of(80, 1, 1, 0, 5);
  m.free.conservativeResize(Eigen::NoChange, 5);
  m.free.col(3) = m.free.col(0) - m.free.col(1);
  m.free.col(4).setZero();
  const Hyperparameters h = estimate(m);
  CHECK(h.noise(0) == doctest::Approx(1).epsilon(0.25));
  CHECK(leave_one_out(m, h).allFinite());
  CHECK(leave_one_out(m, h).norm() > 1);
}

TEST_CASE("a recording of a part that lies far from its targets is the same recording") {
  const LinearModel near = model_of(80, 1, 1, 0, 10);
  LinearModel far = near;
  far.y += 1e7 * near.free.col(1);
  Hyperparameters h;
  h.noise = Vector::Ones(1);
  CHECK((leave_one_out(far, h) - leave_one_out(near, h)).cwiseAbs().maxCoeff() < 1e-5);
  const Precision::Seen a = Precision(near, h).y(), b = Precision(far, h).y();
  CHECK(inner(b, b)(0, 0) == doctest::Approx(inner(a, a)(0, 0)).epsilon(1e-5));
}
