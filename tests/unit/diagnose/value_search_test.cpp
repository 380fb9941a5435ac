#include "engine/diagnose/values/value_search.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "engine/diagnose/model/log_sums.hpp"
#include "engine/diagnose/values/value_estimate.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

constexpr int kValues = 7;

/// Three patterns, each with one variant: of one column, of two, and of one again.
Explanations three_patterns() {
  Explanations all;
  for (int k = 0; k < 3; ++k) {
    Variant v;
    v.explanation = k;
    v.signature.resize(kValues, k == 1 ? 2 : 1);
    for (Eigen::Index j = 0; j < v.signature.cols(); ++j)
      for (int i = 0; i < kValues; ++i) v.signature(i, j) = std::cos((k + 1) * i + 3.0 * double(j));
    all.variants.push_back(v);
    Explanation e;
    e.prior = 1.0 / 3;
    e.variants = {k};
    all.list.push_back(e);
  }
  return all;
}

Matrix covariance_of_values() {
  Matrix v(kValues, kValues);
  for (int i = 0; i < kValues; ++i)
    for (int j = 0; j < kValues; ++j) v(i, j) = 0.3 * std::exp(-0.4 * std::abs(i - j)) + (i == j ? 0.1 : 0);
  return v;
}

Vector deviation_of_values() {
  Vector y(kValues);
  for (int i = 0; i < kValues; ++i) y(i) = std::sin(2.1 * i) + 0.2;
  return y;
}

/// Of a normal law, but for what all laws of as many values share.
double log_normal(const Vector& y, const Matrix& covariance) {
  const Cholesky root(covariance);
  return -0.5 * root.whitened(y).squaredNorm() - root.half_log_determinant();
}

/// The mean over the sizes of the search, as a logarithm, of what a variant is likelier than the machines alone.
double log_bayes_of_values(const Vector& y, const Matrix& alone, const Vector& beside, const Matrix& with,
                           const Matrix& signature) {
  std::vector<double> logs;
  for (const double s : {0.3, 1.0, 3.0, 10.0})
    logs.push_back(log_normal(beside, with + s * s * signature * signature.transpose()) - log_normal(y, alone) -
                   std::log(4.0));
  return log_sum_exp(logs);
}

}  // namespace

TEST_CASE("the evidence of values is that of normal laws") {
  const Matrix v = covariance_of_values();
  const Vector mean = Vector::Constant(kValues, 0.1), y = deviation_of_values();
  const Explanations all = three_patterns();
  const Evidence evidence = ValueSearch(mean, v, all).evidence(y);
  for (int k = 0; k < 3; ++k)
    CHECK(evidence.log_bayes[k] ==
          doctest::Approx(log_bayes_of_values(y - mean, v, y - mean, v, all.variants[k].signature)));
  CHECK(evidence.statistic == doctest::Approx(log_sum_exp(evidence.log_bayes) - std::log(3.0)));
}

TEST_CASE("of what is free nothing counts") {
  const Matrix v = covariance_of_values();
  const Vector mean = Vector::Zero(kValues), y = deviation_of_values();
  const Explanations all = three_patterns();
  const Matrix& free = all.variants[0].signature;
  const ValueSearch search(mean, v, all, free);
  const Evidence evidence = search.evidence(y), shifted = search.evidence(y + 5 * free.col(0));
  CHECK(std::abs(evidence.log_bayes[0]) < 1e-9);
  const Matrix wide = v + 1e6 * free * free.transpose();
  CHECK(evidence.log_bayes[1] ==
        doctest::Approx(log_bayes_of_values(y, wide, y, wide, all.variants[1].signature)).epsilon(1e-4));
  CHECK(shifted.log_bayes[1] == doctest::Approx(evidence.log_bayes[1]));
}

TEST_CASE("near its sizes a variant has an offset and a covariance of its own") {
  const Matrix v = covariance_of_values();
  const Vector mean = Vector::Constant(kValues, 0.1), y = deviation_of_values();
  const Explanations all = three_patterns();
  const Matrix& slopes = all.variants[0].signature;
  const NearSizes near{0.5 * slopes, Vector::Constant(kValues, -0.3), 1.5 * v};
  ValueSearch search(mean, v, all);
  search.linearise(2, near);
  const double expected = log_bayes_of_values(y - mean, v, y - mean - near.offset, near.covariance, near.slopes);
  CHECK(search.evidence(y).log_bayes[2] == doctest::Approx(expected));
  CHECK(search.predicted(2, Vector::Constant(1, 2)).isApprox(slopes.col(0) + near.offset));
  // the same of some of the values alone
  std::vector<Eigen::Index> kept;
  const ValueSearch rest = search.rest(2, {0, 1, 0, 0, 1, 0, 0}, kept);
  CHECK(kept == std::vector<Eigen::Index>{0, 2, 3, 5, 6});
  const double of_rest = log_bayes_of_values((y - mean)(kept), v(kept, kept), (y - mean - near.offset)(kept),
                                             near.covariance(kept, kept), near.slopes(kept, Eigen::all));
  const Evidence evidence = rest.evidence(y(kept));
  REQUIRE(evidence.log_bayes.size() == 1);
  CHECK(evidence.log_bayes[0] == doctest::Approx(of_rest));
}

TEST_CASE("the derivative at the end of a range is taken inwards") {
  const Effect& bending = *find_effect("probe.stylus_bending");  // by a force that is not negative, typically 0.1 N
  const auto p = std::find_if(bending.parameters.begin(), bending.parameters.end(),
                              [](const EffectParameter& parameter) { return parameter.name == "force_N"; });
  REQUIRE(p != bending.parameters.end());
  Variant v;
  v.columns.push_back({static_cast<int>(p - bending.parameters.begin()), 0, p->typical});
  const auto moved_from = [&](double force) {
    return move_within_range(bending, v, Vector::Constant(1, force / p->typical), 0);
  };
  CHECK(moved_from(p->low) > 0);
  CHECK(moved_from(p->typical) > 0);
  CHECK(moved_from(p->high) < 0);
}
