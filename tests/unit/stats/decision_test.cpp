#include "engine/stats/decision.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "draws.hpp"
#include "engine/base/ids.hpp"

using namespace abbe;
using namespace abbe::test;

namespace {

constexpr int kErrors = 100'000;

/// The quantiles of a distribution at equal steps of probability: a sample without scatter.
template <class Quantile>
std::vector<double> quantiles(Quantile quantile) {
  std::vector<double> errors;
  for (int i = 0; i < kErrors; ++i) errors.push_back(quantile((i + 0.5) / kErrors));
  return errors;
}

const std::vector<double>& standard_normal() {
  static const std::vector<double> errors = quantiles([](double p) { return normal_quantile(p); });
  return errors;
}

double normal_distribution(double z) { return std::erfc(-z / std::sqrt(2.0)) / 2; }

/// JCGM 106, 7.2: the conformance probability of a normal value with u = 1.
double normal_conformance(double y, double lower, double upper) {
  return normal_distribution(upper - y) - normal_distribution(lower - y);
}

/// g with Phi(g) - Phi(g - tolerance) = 0.95, u = 1.
double normal_guard_band(double tolerance) {
  double low = 0, high = tolerance / 2;
  for (int i = 0; i < 60; ++i) {
    const double g = (low + high) / 2;
    (normal_distribution(g) - normal_distribution(g - tolerance) < 0.95 ? low : high) = g;
  }
  return (low + high) / 2;
}

}  // namespace

TEST_CASE("guard band of normal errors: 1.645 u far from the other limit, more near it") {
  CHECK(guard_band(standard_normal(), {}, 0.0).value() == doctest::Approx(1.6449).epsilon(1e-4));
  CHECK(guard_band(standard_normal(), 0.0, {}).value() == doctest::Approx(1.6449).epsilon(1e-4));
  CHECK(guard_band(standard_normal(), 0.0, 20.0).value() == doctest::Approx(1.6449).epsilon(1e-4));
  for (const double tolerance : {3.95, 4.0, 4.5, 6.0}) {
    CAPTURE(tolerance);
    CHECK(guard_band(standard_normal(), 10.0, 10.0 + tolerance).value() ==
          doctest::Approx(normal_guard_band(tolerance)).epsilon(1e-3));
  }
}

TEST_CASE("no value conforms to limits nearer each other than 95 % of the errors") {
  CHECK(guard_band(standard_normal(), 0.0, 2 * 1.961));
  CHECK_FALSE(guard_band(standard_normal(), 0.0, 2 * 1.958));
  CHECK(decide(1.958, standard_normal(), 0.0, 2 * 1.958) == Conformity::undecided);
  // Hardly ever is the true value inside; but the value is.
  CHECK(decide(0.01, standard_normal(), 0.0, 0.02) == Conformity::undecided);
  CHECK(decide(0.03, standard_normal(), 0.0, 0.02) == Conformity::does_not_conform);
}

TEST_CASE("verdicts of normal errors are those of the closed form") {
  const double lower = 12.5, upper = 18.5;
  int met[3] = {};
  for (double y = 9; y < 22; y += 0.0625) {
    const double p = normal_conformance(y, lower, upper);
    CAPTURE(y);
    CAPTURE(p);
    const Conformity expected = p >= 0.95 ? Conformity::conforms
        : p <= 0.05                       ? Conformity::does_not_conform
                                          : Conformity::undecided;
    CHECK(decide(y, standard_normal(), lower, upper) == expected);
    ++met[static_cast<int>(expected)];
  }
  CHECK(std::all_of(met, met + 3, [](int count) { return count > 10; }));
}

TEST_CASE("the acceptance limits are where the verdict changes, whatever the distribution") {
  // Exponential: 95 % of the errors lie below 3, and 95 % above 0.05.
  const auto skewed = quantiles([](double p) { return -std::log1p(-p); });
  auto mirrored = skewed;
  for (double& e : mirrored) e = -e;
  for (const auto& errors : {standard_normal(), skewed, mirrored})
    for (const double tolerance : {6.2, 8.0, 30.0}) {
      CAPTURE(tolerance);
      const double g = guard_band(errors, 0.0, tolerance).value();
      for (const double past : {-0.01, 0.01}) {
        const Conformity expected = past > 0 ? Conformity::conforms : Conformity::undecided;
        CHECK(decide(g + past, errors, 0.0, tolerance) == expected);
        CHECK(decide(tolerance - g - past, errors, 0.0, tolerance) == expected);
      }
    }
  CHECK(guard_band(skewed, {}, 9.0).value() == doctest::Approx(2.9957).epsilon(1e-4));
  CHECK(guard_band(skewed, 9.0, {}) == guard_band(mirrored, {}, 9.0));  // either sign counts
}

TEST_CASE("an error that is the same everywhere is a guard band") {
  const std::vector<double> errors(1000, 0.004);
  CHECK(guard_band(errors, 0.0, 0.01) == 0.004);
  CHECK_FALSE(guard_band(errors, 0.0, 0.007));
  CHECK(decide(0.005, errors, 0.0, 0.01) == Conformity::conforms);
  CHECK(decide(0.003, errors, 0.0, 0.01) == Conformity::undecided);
  CHECK(decide(-0.005, errors, 0.0, 0.01) == Conformity::does_not_conform);
}

TEST_CASE("limits that err: the guard band is the least distance from a limit at which a value conforms") {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const double upper = 4.5;
  for (const double wider : {0.0, 0.3, 2.0})
    for (const std::optional<double> lower : {std::optional(-20.0), std::optional(-4.5), std::optional<double>()}) {
      CAPTURE(wider);
      std::vector<double> by_lower, by_upper;
      for (int i = 0; i < 400; ++i) {
        const double value = normal(random), width = wider * normal(random);
        by_lower.push_back(value + width), by_upper.push_back(value - width);
      }
      // Conformity can only begin where an error ends: each is tried, with either sign.
      const auto least = [&](const std::vector<double>& errors, double towards, double limit, double sign) {
        double found = 1e9;
        for (const double e : errors) {
          const double d = -towards * sign * e + 1e-12;
          std::vector<double> low = by_lower, high = by_upper;
          for (double& v : low) v = limit + towards * d + sign * v;
          for (double& v : high) v = limit + towards * d + sign * v;
          if (d < found && conformance_probability({low, high}, lower, upper) >= 0.95) found = d;
        }
        return found;
      };
      double expected = 0;
      for (const double sign : {1.0, -1.0}) {
        expected = std::max(expected, least(by_upper, -1, upper, sign));
        if (lower) expected = std::max(expected, least(by_lower, 1, *lower, sign));
      }
      const std::optional<double> guard = guard_band({by_lower, by_upper}, lower, upper);
      CHECK(guard.has_value() == (expected < (lower ? (upper - *lower) / 2 : 1e9)));
      if (guard) CHECK(*guard == doctest::Approx(expected).epsilon(1e-9));
    }
}

TEST_CASE("a share of exactly 95 % proves, and few errors count whole") {
  std::vector<double> errors(20, 0.0);
  errors[7] = 5;
  CHECK(decide(0, errors, -1.0, 1.0) == Conformity::conforms);
  CHECK(guard_band(errors, -1.0, 1.0) == 0);
  errors.pop_back();
  CHECK(decide(0, errors, -1.0, 1.0) == Conformity::undecided);
  CHECK_FALSE(guard_band(errors, -1.0, 1.0));
  CHECK(guard_band(errors, -6.0, 6.0) == 5);
  CHECK_THROWS_AS(guard_band(std::vector<double>{}, 0.0, 1.0), InternalError);
}

TEST_CASE("what errors of one sign alone disprove is undecided") {
  // With two errors of -0.6 among twenty the true value may be 0.6 less than found, or more: a share of 10 % or none.
  std::vector<double> errors(20, 0.0);
  errors[3] = errors[4] = -0.6;
  CHECK(decide(1.5, errors, {}, 1.0) == Conformity::undecided);
  errors[4] = 0;
  CHECK(decide(1.5, errors, {}, 1.0) == Conformity::does_not_conform);
}

TEST_CASE("verdicts have names") {
  CHECK(name(Conformity::conforms) == "conforms");
  CHECK(name(Conformity::undecided) == "undecided");
  CHECK(name(Conformity::does_not_conform) == "does not conform");
}
