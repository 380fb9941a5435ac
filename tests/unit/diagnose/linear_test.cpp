#include "engine/diagnose/model/linear.hpp"

#include <doctest/doctest.h>
#include <Eigen/Dense>
#include <cmath>

#include "engine/lanes/random.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

double normal(std::uint32_t address) {
  return normal_quantile(uniform_pair({7, address, stream_of("linear_test"), 0, 0, 0}).a);
}

Matrix random_matrix(int rows, int columns, std::uint32_t stream) {
  Matrix m(rows, columns);
  for (int i = 0; i < rows; ++i)
    for (int k = 0; k < columns; ++k) m(i, k) = normal(stream + static_cast<std::uint32_t>(1000 * i + k));
  return m;
}

LinearModel model_of(int rows, double scale, double noise, double phi, std::uint32_t stream) {
  LinearModel m;
  m.free = random_matrix(rows, 3, stream + 1'000'000);
  m.random = 2 * random_matrix(rows, 12, stream + 2'000'000);
  m.random_group.assign(12, 0);
  m.noise_um = Vector::Constant(rows, 0.5);
  m.noise_group.assign(static_cast<std::size_t>(rows), 0);
  m.follows.assign(static_cast<std::size_t>(rows), 1);
  m.follows[0] = 0;
  Vector e(rows), u(12);
  for (int k = 0; k < 12; ++k) u(k) = scale * normal(stream + 3'000'000 + static_cast<std::uint32_t>(k));
  for (int i = 0; i < rows; ++i) {
    const double white = normal(stream + 4'000'000 + static_cast<std::uint32_t>(i));
    e(i) = i == 0 ? white : phi * e(i - 1) + std::sqrt(1 - phi * phi) * white;
  }
  m.y = m.free * Vector::Constant(3, 40.0) + m.random * u + 0.5 * noise * e;
  return m;
}

/// The inverse covariance with the free columns projected out, dense and by definition.
Matrix dense_precision(const LinearModel& m, const Hyperparameters& h, const Matrix& noise) {
  const Matrix v = h.scale * h.scale * m.random * m.random.transpose() + noise, inverse = v.inverse(), x = m.free;
  return inverse - inverse * x * (x.transpose() * inverse * x).inverse() * x.transpose() * inverse;
}

Matrix dense_precision(const LinearModel& m, const Hyperparameters& h) {
  Vector variance(m.y.size());
  for (Eigen::Index i = 0; i < variance.size(); ++i)
    variance(i) = std::pow(m.noise_um(i) * h.noise(m.noise_group[static_cast<std::size_t>(i)]), 2);
  return dense_precision(m, h, Matrix(variance.asDiagonal()));
}

}  // namespace

TEST_CASE("the caches of the processor have no say in how products are summed") {
  // Eigen sums long products in blocks made for the caches it finds, and so to other last bits on another processor.
  Matrix a(1134, 4), b(1134, 4);
  for (int i = 0; i < a.size(); ++i) a(i) = std::sin(i), b(i) = std::cos(3 * i);
  const Matrix here = a.transpose() * b;
  Eigen::setCpuCacheSizes(32 << 10, 256 << 10, 2 << 20);
  const Matrix elsewhere = a.transpose() * b;
  CHECK(here == elsewhere);
}

TEST_CASE("residuals predicted from all other rows are those of the dense formula") {
  const LinearModel m = model_of(60, 1, 1, 0, 1);
  Hyperparameters h;
  h.scale = 1.3;
  h.noise = Vector::Constant(1, 0.8);
  const Matrix p = dense_precision(m, h);
  const Vector py = p * m.y, loo = leave_one_out(m, h);
  for (Eigen::Index i = 0; i < loo.size(); ++i)
    CHECK(loo(i) == doctest::Approx(py(i) / std::sqrt(p(i, i))).epsilon(1e-6));
  // cov(P y) = P, so the correlations of the residuals are those of P.
  const Matrix squared = squared_correlation(m, h);
  for (Eigen::Index i = 0; i < 60; ++i)
    for (Eigen::Index j = 0; j < 60; ++j)
      CHECK(squared(i, j) == doctest::Approx(p(i, j) * p(i, j) / (p(i, i) * p(j, j))).epsilon(1e-6));
}

TEST_CASE("the precision of the touches is that of the dense formula") {
  const LinearModel m = model_of(60, 1, 1, 0, 5);
  Hyperparameters h;
  h.scale = 1.3, h.noise = Vector::Constant(1, 0.8);
  CHECK((precision(m, h) - dense_precision(m, h)).cwiseAbs().maxCoeff() < 1e-8);
}

TEST_CASE("of a displacement that X makes nothing shows, and of another what is beside it") {
  const LinearModel m = model_of(60, 1, 1, 0, 6);
  const Vector made = m.free * Vector::Constant(3, 20.0), other = random_matrix(60, 1, 9'000'000).col(0);
  CHECK(beside_free(m, made).cwiseAbs().maxCoeff() < 1e-9);
  const Vector shows = beside_free(m, made + other);
  CHECK((m.free.transpose() * shows).cwiseAbs().maxCoeff() < 1e-9);
  CHECK((beside_free(m, other) - shows).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("a touch is left out itself, not its difference from the touch before") {
  LinearModel m = model_of(60, 1, 1, 0.5, 21);
  m.follows[30] = 0;
  Hyperparameters h;
  h.noise = Vector::Constant(1, 0.8), h.correlation = 0.6;
  Matrix noise = Matrix::Zero(60, 60);
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j)
      if ((i < 30) == (j < 30)) noise(i, j) = std::pow(0.5 * 0.8, 2) * std::pow(0.6, std::abs(i - j));
  const Matrix p = dense_precision(m, h, noise);
  const Vector py = p * m.y, loo = leave_one_out(m, h), expected = noise * py, own = expected_noise(m, h);
  const Matrix squared = squared_correlation(m, h);
  for (Eigen::Index i = 0; i < 60; ++i) {
    CHECK(loo(i) == doctest::Approx(py(i) / std::sqrt(p(i, i))).epsilon(1e-6));
    CHECK(own(i) == doctest::Approx(expected(i)).epsilon(1e-6));  // E(e | y) = cov(e, y) P y
    for (Eigen::Index j = 0; j < 60; ++j)
      CHECK(std::sqrt(squared(i, j)) ==
            doctest::Approx(std::abs(p(i, j)) / std::sqrt(p(i, i) * p(j, j))).epsilon(1e-6));
  }
}

TEST_CASE("of one place touched again and again, the noise is all that differs") {
  LinearModel m = model_of(30, 1, 1, 0, 22);
  m.free = Matrix::Ones(30, 1);
  m.random = 3 * Matrix::Ones(30, 12);
  Hyperparameters h;
  h.noise = Vector::Constant(1, 1.3);
  const Vector rest = m.y - expected_noise(m, h);
  CHECK((rest.array() - rest.mean()).abs().maxCoeff() < 1e-9);
}

TEST_CASE("rows that are left out are as far off as they were moved, whatever their neighbours have in common") {
  LinearModel m = model_of(200, 1, 1, 0.5, 8);
  const Hyperparameters h = estimate(m);
  REQUIRE(h.correlation > 0);
  std::vector<char> masked(200, 0);
  const double before = beyond_prediction(m, h, [&] { return masked[40] = masked[41] = 1, masked; }())(40);
  CHECK(std::abs(before) < 4 * 0.5);
  m.y(40) += 30;
  const Vector off = beyond_prediction(m, h, masked);
  CHECK(off(40) - before == doctest::Approx(30).epsilon(1e-3));
  CHECK(off(39) == 0);
}

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

TEST_CASE("densities under two noises compare as by the dense formula") {
  LinearModel m = model_of(60, 1, 1, 0.5, 11);
  m.follows[30] = 0;
  const Eigen::Index n = m.y.size();
  const auto dense = [&](const Hyperparameters& h) {
    Matrix v = Matrix::Zero(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j)
        if ((i < 30) == (j < 30))
          v(i, j) = std::pow(0.5 * h.noise(0), 2) * std::pow(h.correlation, std::abs(double(i - j)));
    v += h.scale * h.scale * m.random * m.random.transpose();
    const Matrix inverse = v.inverse(), x = m.free, of_free = x.transpose() * inverse * x;
    const double squares = m.y.dot(inverse * m.y) -
        (x.transpose() * inverse * m.y).dot(of_free.inverse() * (x.transpose() * inverse * m.y));
    return -0.5 *
        (Eigen::FullPivLU<Matrix>(v).matrixLU().diagonal().array().abs().log().sum() + std::log(of_free.determinant()) +
         squares);
  };
  const auto rotated = [&](const Hyperparameters& h) {
    const Rotated r(m, h);
    const Vector z = r.z(), variance = 1 + r.lambda().array();
    return log_density(m, h) -
        0.5 *
        (variance.array().log().sum() + (z.array().square() / variance.array()).sum() +
         r.remainder(r.y(), z).squaredNorm());
  };
  Hyperparameters correlated, white;
  correlated.noise = Vector::Constant(1, 0.8), correlated.correlation = 0.45, correlated.scale = 1.2;
  white.noise = Vector::Constant(1, 1.1);
  CHECK(rotated(correlated) - rotated(white) == doctest::Approx(dense(correlated) - dense(white)).epsilon(1e-9));
}

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
