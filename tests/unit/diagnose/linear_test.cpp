#include "engine/diagnose/model/linear.hpp"

#include <doctest/doctest.h>
#include <cmath>

#include "tests/unit/diagnose/random_model.hpp"

using namespace abbe;
using namespace abbe::diagnose;

TEST_CASE("the caches of the processor have no say in how products are summed") {
  // Eigen sums long products in blocks made for the caches it finds, and so to other last bits on another processor.
  Matrix a(1134, 4), b(1134, 4);
  for (int i = 0; i < a.size(); ++i) a(i) = std::sin(i), b(i) = std::cos(3 * i);
  const Matrix here = a.transpose() * b;
  Eigen::setCpuCacheSizes(32 << 10, 256 << 10, 2 << 20);
  const Matrix elsewhere = a.transpose() * b;
  CHECK(here == elsewhere);
}

TEST_CASE("of a displacement that X makes nothing shows, and of another what is beside it") {
  const LinearModel m = model_of(60, 1, 1, 0, 6);
  const Vector made = m.free * Vector::Constant(3, 20.0), other = random_matrix(60, 1, 9'000'000).col(0);
  CHECK(beside_free(m, made).cwiseAbs().maxCoeff() < 1e-9);
  const Vector shows = beside_free(m, made + other);
  CHECK((m.free.transpose() * shows).cwiseAbs().maxCoeff() < 1e-9);
  CHECK((beside_free(m, other) - shows).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("a row with an unknown of its own is alone") {
  LinearModel m = model_of(80, 1, 1, 0, 5);
  CHECK(alone(m) == std::vector<char>(80, 0));
  m.free.conservativeResize(Eigen::NoChange, m.free.cols() + 2);
  m.free.rightCols(2).setZero();
  m.free(7, m.free.cols() - 2) = 0.3;
  m.free(8, m.free.cols() - 1) = m.free(9, m.free.cols() - 1) = 1;  // shared by two: their difference tells
  std::vector<char> expected(80, 0);
  expected[7] = 1;
  CHECK(alone(m) == expected);
}

TEST_CASE("a compact model is the same model") {
  LinearModel m = model_of(80, 1, 1, 0, 6);
  const Eigen::Index before = m.random.cols();
  m.random.conservativeResize(Eigen::NoChange, before + 2);
  m.random.col(before) = m.random.col(0);
  m.random.col(before + 1) = 1e-5 * m.y;
  m.random_group.resize(static_cast<std::size_t>(before) + 2, 0);
  const LinearModel c = compact(m);
  CHECK(c.random.cols() <= before);
  CHECK((c.random * c.random.transpose() - m.random * m.random.transpose()).cwiseAbs().maxCoeff() < 1e-3);
}
