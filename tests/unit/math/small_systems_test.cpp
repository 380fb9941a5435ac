#include <doctest/doctest.h>

#include "engine/math/cholesky.hpp"
#include "engine/math/eigen3.hpp"
#include "engine/math/jet.hpp"

using namespace abbe;

TEST_CASE("a system in badly mixed units is solved") {
  // D A D with A = [4 2 1; 2 5 3; 1 3 6] and D = diag(1e-6, 1, 1e6); solution D^-1 (1, -2, 3).
  const double a[3][3] = {{4, 2, 1}, {2, 5, 3}, {1, 3, 6}}, d[3] = {1e-6, 1, 1e6}, y[3] = {1, -2, 3};
  SymmetricSystem<double, 3> s;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) s.a[i][j] = d[i] * a[i][j] * d[j], s.b[i] += d[i] * a[i][j] * y[j];
  double x[3];
  REQUIRE(solve_positive_definite(s, x, 1e-14));
  for (int i = 0; i < 3; ++i) CHECK(x[i] * d[i] == doctest::Approx(y[i]).epsilon(1e-14));
}

TEST_CASE("systems that are not positive definite are refused") {
  double x[2];
  CHECK_FALSE(solve_positive_definite(SymmetricSystem<double, 2>{{{1, 0}, {1, 1}}, {1, 1}}, x, 1e-14));   // singular
  CHECK_FALSE(solve_positive_definite(SymmetricSystem<double, 2>{{{1, 0}, {2, 1}}, {1, 1}}, x, 1e-14));   // a saddle
  CHECK_FALSE(solve_positive_definite(SymmetricSystem<double, 2>{{{1, 0}, {0, -1}}, {1, 1}}, x, 1e-14));  // a maximum
  CHECK_FALSE(solve_positive_definite(SymmetricSystem<double, 2>{{{NAN, 0}, {0, 1}}, {1, 1}}, x, 1e-14));
  CHECK_FALSE(solve_positive_definite(SymmetricSystem<double, 2>{{{1, 0}, {0, 1}}, {NAN, 1}}, x, 1e-14));
}

TEST_CASE("eigenvectors diagonalise the matrix, largest value first") {
  const double m[3][3] = {{2, -1, 0.5}, {-1, 3, 0.25}, {0.5, 0.25, -1}};
  const Eigen3<double> e = eigen_symmetric(m);
  CHECK(e.value[0] > e.value[1]);
  CHECK(e.value[1] > e.value[2]);
  CHECK(e.value[0] + e.value[1] + e.value[2] == doctest::Approx(4));
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i) {
      double product = 0;
      for (int j = 0; j < 3; ++j) product += m[i][j] * e.vector[k][j];
      CHECK(product == doctest::Approx(e.value[k] * e.vector[k][i]).epsilon(1e-14));
    }
}

TEST_CASE("small eigenvalues of a graded matrix are accurate relative to themselves") {
  // D A D, D = diag(1, 1e-6, 1e-12): the smallest eigenvalue is 1e-24 / (A^-1)_33 in the limit.
  const double a[3][3] = {{1, 0.5, 0.25}, {0.5, 1, 0.5}, {0.25, 0.5, 1}}, d[3] = {1, 1e-6, 1e-12};
  double m[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m[i][j] = d[i] * a[i][j] * d[j];
  CHECK(eigen_symmetric(m).value[2] / 0.75e-24 == doctest::Approx(1).epsilon(1e-10));
}

TEST_CASE("jets carry exact first and second derivatives") {
  using J = Jet<double, 2>;
  const double x = 0.7, y = -1.3;
  const J a = J::unknown(x, 0), b = J::unknown(y, 1);
  const J f = sin(a * b) + sqrt(a + J(2.0) - b) * cos(b) + reciprocal(a);
  const auto value = [](double u, double v) { return std::sin(u * v) + std::sqrt(u + 2 - v) * std::cos(v) + 1 / u; };
  const double h = 1e-4;
  CHECK(f.value == doctest::Approx(value(x, y)).epsilon(1e-15));
  CHECK(f.gradient[0] == doctest::Approx((value(x + h, y) - value(x - h, y)) / (2 * h)).epsilon(1e-6));
  CHECK(f.gradient[1] == doctest::Approx((value(x, y + h) - value(x, y - h)) / (2 * h)).epsilon(1e-6));
  CHECK(f.hessian[0][0] ==
        doctest::Approx((value(x + h, y) - 2 * value(x, y) + value(x - h, y)) / (h * h)).epsilon(1e-5));
  CHECK(f.hessian[1][1] ==
        doctest::Approx((value(x, y + h) - 2 * value(x, y) + value(x, y - h)) / (h * h)).epsilon(1e-5));
  CHECK(f.hessian[1][0] ==
        doctest::Approx((value(x + h, y + h) - value(x + h, y - h) - value(x - h, y + h) + value(x - h, y - h)) /
                        (4 * h * h))
            .epsilon(1e-5));
}
