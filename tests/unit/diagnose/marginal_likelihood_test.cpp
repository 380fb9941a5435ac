#include "engine/diagnose/model/marginal_likelihood.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/diagnose/random_model.hpp"

namespace abbe::diagnose {

namespace {

constexpr int kScales = 3, kColumns = 6;  // more than are summed together
constexpr double kShape = 7.5;
constexpr double kFactors[] = {0.5, 2, 4};

/// Of a variant with some G at each scale.
struct Judged {
  std::vector<Matrix> g;
  PreparedVariant variant{0, kColumns, sizes(), kScales};
  Matrix squares;
  Vector log_scale;
  std::vector<Matrix> u;  ///< by column of the variant: a row a recording, a column a scale

  static std::vector<Size> sizes() {
    std::vector<Size> out;
    for (const double factor : kFactors) out.push_back({factor, std::log(1.0 / std::size(kFactors))});
    return out;
  }

  explicit Judged(int recordings) : squares(recordings, kScales), log_scale(random_matrix(kScales, 1, 3'000)) {
    for (int j = 0; j < kScales; ++j) {
      const Matrix h = random_matrix(9, kColumns, 100 * j);
      g.push_back(h.transpose() * h);
      variant.set(j, g.back(), 1);
    }
    for (int i = 0; i < kColumns; ++i) u.push_back(random_matrix(recordings, kScales, 5'000 * (i + 1)));
    squares = 30 + random_matrix(recordings, kScales, 7'000).array().square();
  }

  WithData data() const {
    WithData out;
    for (const Matrix& column : u) out.push_back(column.data());
    return out;
  }
  MarginalLikelihood likelihood() const { return {squares, log_scale, kShape}; }
  Vector with() const {
    Vector out(squares.rows());
    likelihood().with(variant, data(), out.data());
    return out;
  }
  /// By definition: the sum over scales and sizes of prior, determinants, and what is left to a power.
  double sum(int recording) const {
    double out = 0;
    for (int j = 0; j < kScales; ++j)
      for (const auto& [factor, log_prior] : variant.sizes) {
        const double s2 = factor * factor;
        const Matrix one_and_g = Matrix::Identity(kColumns, kColumns) + s2 * g[static_cast<std::size_t>(j)];
        const Vector v =
            Vector::NullaryExpr(kColumns, [&](Eigen::Index i) { return u[static_cast<std::size_t>(i)](recording, j); });
        const double left = squares(recording, j) - s2 * v.dot(Cholesky(one_and_g).solve(v));
        out +=
            std::exp(log_scale(j) + log_prior - Cholesky(one_and_g).half_log_determinant()) * std::pow(left, -kShape);
      }
    return out;
  }
};

}  // namespace

TEST_CASE("marginal likelihoods are those of their definition") {
  const Judged of(3);
  const Vector with = of.with(), alone = of.likelihood().alone();
  for (int r = 0; r < 3; ++r) {
    CHECK(with(r) == doctest::Approx(std::log(of.sum(r))).epsilon(1e-13));
    double sum = 0;
    for (int j = 0; j < kScales; ++j) sum += std::exp(of.log_scale(j)) * std::pow(of.squares(r, j), -kShape);
    CHECK(alone(r) == doctest::Approx(std::log(sum)).epsilon(1e-13));
  }
}

TEST_CASE("what is judged by scale adds up to what is judged over all") {
  const Judged of(1);
  const ByScale with = of.likelihood().with_by_scale(of.variant, of.data()), alone = of.likelihood().alone_by_scale();
  CHECK(std::log(with.log_likelihood.array().exp().sum()) == doctest::Approx(of.with()(0)).epsilon(1e-14));
  CHECK(std::log(alone.log_likelihood.array().exp().sum()) ==
        doctest::Approx(of.likelihood().alone()(0)).epsilon(1e-14));
  CHECK(alone.squares == Vector(of.squares.row(0)));
  for (int j = 0; j < kScales; ++j) {
    CHECK(with.squares(j) < alone.squares(j));
    CHECK(std::find(std::begin(kFactors), std::end(kFactors), with.size(j)) != std::end(kFactors));
  }
}

TEST_CASE("a recording has the same likelihood to the bit beside any number of others") {
  const Judged many(23);
  const Vector together = many.with();
  for (int r = 0; r < 23; ++r) {
    Judged one(1);
    one.squares = many.squares.row(r);
    for (int i = 0; i < kColumns; ++i) one.u[static_cast<std::size_t>(i)] = many.u[static_cast<std::size_t>(i)].row(r);
    CHECK(one.with()(0) == together(r));
  }
}

}  // namespace abbe::diagnose
