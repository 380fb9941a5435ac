#include "engine/diagnose/model/decompositions.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/unit/diagnose/random_model.hpp"

namespace abbe::diagnose {

namespace {

constexpr double kRounding = 1e-12;

double distance(const Matrix& a, const Matrix& b) { return (a - b).cwiseAbs().maxCoeff(); }

Matrix one(Eigen::Index size) { return Matrix::Identity(size, size); }

/// Of five rows: three of its four columns are independent.
Matrix deficient() {
  Matrix a = random_matrix(5, 4, 11'000);
  a.col(3) = 2 * a.col(0) - a.col(1);
  return a;
}

}  // namespace

TEST_CASE("the spectrum of a symmetric matrix makes it again") {
  const Matrix a = random_matrix(6, 4, 10'000), s = a.transpose() * a - one(4);
  const auto [values, vectors] = spectrum(s);
  CHECK(distance(vectors * values.asDiagonal() * vectors.transpose(), s) < kRounding);
  CHECK(distance(vectors.transpose() * vectors, one(4)) < kRounding);
  for (int k = 1; k < 4; ++k) CHECK(values(k) >= values(k - 1));
}

TEST_CASE("a spectrum beside another matrix makes both diagonal") {
  const Matrix a = random_matrix(6, 4, 10'000), b = random_matrix(6, 4, 20'000);
  const Matrix s = a.transpose() * a, p = b.transpose() * b;
  const auto [values, vectors] = spectrum_beside(s, p);
  CHECK(distance(vectors.transpose() * p * vectors, one(4)) < kRounding);
  CHECK(distance(vectors.transpose() * s * vectors, values.asDiagonal()) < kRounding * values.maxCoeff());
}

TEST_CASE("roots of matrices make them again") {
  const Matrix a = random_matrix(6, 4, 10'000), p = a.transpose() * a, wide = a.transpose(), thin = deficient();
  const Matrix root = inverse_root(p);
  CHECK(distance(root * p * root, one(4)) < kRounding);
  CHECK(distance(root, root.transpose()) < kRounding);
  const Matrix singular = thin * thin.transpose(), factor = factor_of(singular);
  CHECK(distance(factor * factor.transpose(), singular) < 10 * kRounding);
  REQUIRE(wide.cols() > wide.rows());
  CHECK(no_wider(wide).cols() == wide.rows());
  CHECK(distance(no_wider(wide) * no_wider(wide).transpose(), p) < 10 * kRounding);
  CHECK(no_wider(a) == a);
}

TEST_CASE("the Cholesky factor solves, whitens and has the determinant") {
  const Matrix a = random_matrix(9, 3, 30'000), b = random_matrix(3, 2, 40'000), g = a.transpose() * a;
  const Matrix p = g + 0.5 * one(3);
  const Cholesky root(g, 0.5);
  const Vector v = b.col(0);
  CHECK(distance(root.lower() * root.lower().transpose(), p) < kRounding);
  CHECK(root.lower()(0, 2) == 0);
  CHECK(distance(p * root.solve(b), b) < kRounding);
  CHECK(distance(p * root.solve(v), v) < kRounding);
  CHECK(distance(p * root.inverse(), one(3)) < kRounding);
  CHECK(distance(root.lower() * root.whitened(b), b) < kRounding);
  CHECK(distance(root.lower() * root.whitened(v), v) < kRounding);
  const double determinant = p(0, 0) * (p(1, 1) * p(2, 2) - p(1, 2) * p(2, 1)) -
      p(0, 1) * (p(1, 0) * p(2, 2) - p(1, 2) * p(2, 0)) + p(0, 2) * (p(1, 0) * p(2, 1) - p(1, 1) * p(2, 0));
  CHECK(root.half_log_determinant() == doctest::Approx(0.5 * std::log(determinant)));
}

TEST_CASE("a matrix that is not positive definite has no Cholesky factor") {
  Matrix p(2, 2);
  p << 1, 2, 2, 1;
  CHECK_THROWS(Cholesky(p));
}

TEST_CASE("least squares are the shortest of columns that depend on each other") {
  const Matrix a = deficient(), b = random_matrix(5, 2, 50'000), x = least_squares(a, b);
  CHECK(distance(a.transpose() * (b - a * x), Matrix::Zero(4, 2)) < 10 * kRounding);
  Vector nothing(4);  // a times it is zero
  nothing << 2, -1, 0, -1;
  CHECK((x.transpose() * nothing).cwiseAbs().maxCoeff() < 10 * kRounding);
  CHECK(distance(least_squares(a, Vector(b.col(1))), x.col(1)) < 10 * kRounding);
}

TEST_CASE("what columns explain is the squared length of the projection on them") {
  const Matrix a = deficient(), b = random_matrix(5, 2, 50'000), q = independent(a);
  const Vector squares = (q.transpose() * b).colwise().squaredNorm();
  constexpr double kRidge = 1e-7;  // keeps it from dividing by nothing
  CHECK(distance(explained(a.transpose() * a, a.transpose() * b), squares) < kRidge);
  CHECK(explained(Matrix::Zero(2, 2), Matrix::Zero(2, 3)) == Vector::Zero(3));
}

TEST_CASE("the inverse of a singular matrix is one in the space that it spans") {
  const Matrix a = deficient(), g = a.transpose() * a, inverse = pseudo_inverse(g);
  CHECK(distance(g * inverse * g, g) < 100 * kRounding);
  CHECK(distance(inverse * g * inverse, inverse) < 100 * kRounding);
  CHECK(distance(g * inverse, (g * inverse).transpose()) < 100 * kRounding);
}

TEST_CASE("independent columns are orthonormal and span what those span") {
  Matrix a = deficient();
  a.col(1) *= 1e-9;  // a matter of units
  a.col(3) = 2 * a.col(0) - 1e9 * a.col(1);
  const Matrix q = independent(a);
  REQUIRE(q.cols() == 3);
  CHECK(distance(q.transpose() * q, one(3)) < kRounding);
  CHECK(distance(q * (q.transpose() * a), a) < kRounding);
  a.col(3) += 1e-8 * random_matrix(5, 1, 60'000);  // less than the rounding of targets
  CHECK(independent(a).cols() == 3);
}

}  // namespace abbe::diagnose
