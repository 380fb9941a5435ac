#include "engine/diagnose/model/marginal_likelihood.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/diagnose/random_model.hpp"

namespace abbe::diagnose {

namespace {

constexpr int kScales = 3, kColumns = 2;
constexpr double kShape = 7.5;
constexpr double kFactors[] = {0.5, 2, 4};

/// Of a variant with G = E diag(d) E' at each scale.
struct Judged {
  std::vector<Matrix> g;
  PreparedVariant variant;
  Matrix squares;
  Vector log_scale;
  std::vector<Matrix> u;  ///< by column of the variant: a row a recording, a column a scale

  explicit Judged(int recordings) : squares(recordings, kScales), log_scale(random_matrix(kScales, 1, 3'000)) {
    const auto sizes = static_cast<Eigen::Index>(std::size(kFactors));
    variant.count = kColumns;
    variant.axes.resize(kColumns, kColumns * kScales);
    variant.share.resize(sizes, kColumns * kScales);
    variant.log_weight.resize(sizes, kScales);
    for (const double factor : kFactors) variant.sizes.push_back({factor, std::log(1.0 / std::size(kFactors))});
    for (int j = 0; j < kScales; ++j) {
      const Matrix h = random_matrix(5, kColumns, 100 * j);
      g.push_back(h.transpose() * h);
      const auto [d, axes] = spectrum(g.back());
      variant.axes.middleCols(j * kColumns, kColumns) = axes.transpose();
      for (Eigen::Index s = 0; s < sizes; ++s) {
        const auto& [factor, log_prior] = variant.sizes[static_cast<std::size_t>(s)];
        const double s2 = factor * factor;
        variant.share.block(s, j * kColumns, 1, kColumns) = (s2 / (1 + s2 * d.array())).transpose();
        variant.log_weight(s, j) = log_prior - 0.5 * (1 + s2 * d.array()).log().sum();
      }
    }
    for (int i = 0; i < kColumns; ++i) u.push_back(random_matrix(recordings, kScales, 5'000 * (i + 1)));
    squares = 30 + random_matrix(recordings, kScales, 7'000).array().square();
  }

  MarginalLikelihood likelihood() const { return {squares, log_scale, kShape}; }
  Vector with() const {
    Vector out(squares.rows());
    likelihood().with(variant, {u[0].data(), u[1].data()}, out.data());
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
  const ByScale with = of.likelihood().with_by_scale(of.variant, {of.u[0].data(), of.u[1].data()}),
                alone = of.likelihood().alone_by_scale();
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
