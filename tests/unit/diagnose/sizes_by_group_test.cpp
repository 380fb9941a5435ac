#include "engine/diagnose/model/sizes_by_group.hpp"

#include <doctest/doctest.h>
#include <cmath>

#include "engine/lanes/random.hpp"
#include "engine/math/normal.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

double normal_at(std::uint32_t address) {
  return normal_quantile(uniform_pair({11, address, stream_of("sizes_by_group_test"), 0, 0, 0}).a);
}

/// A shape of so many rows that swings four times, and its groups: the thirds of the sequence.
constexpr int kRows = 90;
Matrix swing() {
  Matrix m(kRows, 1);
  for (int i = 0; i < kRows; ++i) m(i) = std::sin(8 * 3.14159 * i / kRows);
  return m;
}
std::vector<int> thirds() {
  std::vector<int> out;
  for (int i = 0; i < kRows; ++i) out.push_back(7 + 3 * i / kRows);
  return out;
}

/// A recording with errors of a machine, an unknown offset, and the shape at these sizes in the thirds.
LinearModel recorded(double first, double second, double third, std::uint32_t number) {
  LinearModel m;
  m.free = Matrix::Ones(kRows, 1);
  m.random = Matrix(kRows, 2);
  m.y = Vector(kRows);
  const double a = normal_at(1000 * number), b = normal_at(1000 * number + 1);
  for (int i = 0; i < kRows; ++i) {
    m.random.row(i) << i / double(kRows), std::cos(i / 30.0);
    const double size = 3 * i < kRows ? first : 3 * i < 2 * kRows ? second : third;
    m.y(i) = 7 + a * m.random(i, 0) + b * m.random(i, 1) + size * swing()(i) +
        0.5 * normal_at(1000 * number + 2 + static_cast<std::uint32_t>(i));
  }
  m.random_group = {0, 0};
  m.noise_um = Vector::Constant(kRows, 0.5);
  m.noise_group.assign(kRows, 0);
  m.follows.assign(kRows, 0);
  return m;
}

Hyperparameters as_stated() {
  Hyperparameters h;
  h.noise = Vector::Ones(1);
  return h;
}

}  // namespace

TEST_CASE("a shape of one size is taken for one of several as often as is said") {
  // Of 1000 recordings 50 have p < 5 % in the mean, 3.3 standard deviations either way are 27 to 73.
  int below = 0;
  const Matrix shape = swing();
  for (std::uint32_t k = 0; k < 1000; ++k) {
    const SizesByGroup s = OneShape(recorded(0.4, 0.4, 0.4, k), as_stated(), {&shape}, 0).by(thirds());
    REQUIRE(s.dof == 2);
    below += s.p() < 0.05;
  }
  CHECK(below >= 27);
  CHECK(below <= 73);
}

TEST_CASE("a shape of which one third has nothing is of several sizes, and the third is told") {
  const Matrix shape = swing();
  const SizesByGroup s = OneShape(recorded(1, 1, 0, 1), as_stated(), {&shape}, 0).by(thirds());
  CHECK(s.p() < 1e-6);
  // two thirds of the touches have it, so all have two thirds of it
  CHECK(std::abs(s.size(0) - 1.5) < 3 * s.u(0));
  CHECK(std::abs(s.size(2)) < 3 * s.u(2));
  CHECK(s.u(0) < 0.3);
}

TEST_CASE("what is found beside a shape takes its own part of what differs") {
  // The third without it has the opposite shape beside it, which is found as well.
  const Matrix shape = swing();
  Matrix beside = shape;
  beside.topRows(2 * kRows / 3).setZero();
  const LinearModel m = recorded(1, 1, 0, 1);
  CHECK(OneShape(m, as_stated(), {&shape}, 0).by(thirds()).p() < 1e-6);
  const SizesByGroup s = OneShape(m, as_stated(), {&beside, &shape}, 1).by(thirds());
  CHECK(s.dof == 1);
  CHECK(s.p() > 0.05);
}

TEST_CASE("where a shape shows in one group only, its size cannot differ") {
  Matrix shape = swing();
  shape.bottomRows(2 * kRows / 3).setZero();
  const SizesByGroup s = OneShape(recorded(1, 0, 0, 1), as_stated(), {&shape}, 0).by(thirds());
  CHECK(s.dof == 0);
  CHECK(s.p() == 1);
  CHECK(std::isinf(s.u(1)));
}
