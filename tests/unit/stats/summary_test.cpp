#include "engine/stats/summary.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "draws.hpp"
#include "engine/base/ids.hpp"

using namespace abbe;
using namespace abbe::test;

namespace {

std::vector<double> first_integers(int n) {
  std::vector<double> y(n);
  std::iota(y.begin(), y.end(), 1.0);
  return y;
}

}  // namespace

TEST_CASE("ranks of the symmetric interval follow JCGM 101 7.7.1") {
  // M = 1000: q = 950, r = 25.
  CHECK(summarize(first_integers(1000)).symmetric.low == 25);
  CHECK(summarize(first_integers(1000)).symmetric.high == 975);
  // M = 101: pM = 95.95, q = 96, M - q = 5 is odd, r = 3.
  CHECK(summarize(first_integers(101)).symmetric.low == 3);
  CHECK(summarize(first_integers(101)).symmetric.high == 99);
  // Too small for 95 %: the whole sample.
  CHECK(summarize(first_integers(10)).symmetric.low == 1);
  CHECK(summarize(first_integers(10)).symmetric.high == 10);
}

TEST_CASE("the errors of few machines are about those that they have") {
  // Of samples of 5 and 20 normal values: the standard deviations of u and of the 2.5 % point, over many samples, against
  // the root mean squares of what each sample says. 2000 samples tell either to 2 %; within a quarter is asked for, because
  // so few values do not tell their own scatter.
  for (const int n : {5, 20}) {
    constexpr int kSamples = 2000;
    double u = 0, u2 = 0, low = 0, low2 = 0, said_u2 = 0, said_low2 = 0;
    for (int k = 0; k < kSamples; ++k) {
      Trial trial(7, static_cast<std::uint32_t>(k));
      std::vector<double> y;
      for (int i = 0; i < n; ++i) y.push_back(trial.normal());
      const Summary s = summarize(y);
      u += s.u / kSamples, u2 += s.u * s.u / kSamples;
      low += s.symmetric.low / kSamples, low2 += s.symmetric.low * s.symmetric.low / kSamples;
      said_u2 += s.u_error * s.u_error / kSamples, said_low2 += s.low_error * s.low_error / kSamples;
    }
    CHECK(std::sqrt(said_u2 / (u2 - u * u)) == doctest::Approx(1).epsilon(0.25));
    CHECK(std::sqrt(said_low2 / (low2 - low * low)) == doctest::Approx(1).epsilon(0.25));
  }
}

TEST_CASE("the shortest interval sits where the sample is dense") {
  // Squares are dense at the low end: the shortest interval begins with the smallest value.
  std::vector<double> y = first_integers(100);
  for (double& v : y) v *= v;
  const Summary s = summarize(y);
  CHECK(s.shortest.low == 1);
  CHECK(s.shortest.high == 96 * 96);
}

TEST_CASE("of equally short intervals the one nearest to the symmetric interval is taken") {
  const Summary s = summarize(first_integers(1000));  // every interval of 950 steps is as short
  CHECK(s.shortest.low == s.symmetric.low);
  CHECK(s.shortest.high == s.symmetric.high);
}

TEST_CASE("mean and u of a small sample by hand") {
  const std::vector<double> y{2, 4, 4, 4, 5, 5, 7, 9};
  const Summary s = summarize(y);
  CHECK(s.n == 8);
  CHECK(s.mean == 5);
  CHECK(s.u == doctest::Approx(std::sqrt(32.0 / 7)).epsilon(1e-15));
  CHECK(s.mean_error == doctest::Approx(std::sqrt(32.0 / 7 / 8)).epsilon(1e-15));
  // m4 = (81 + 3 + 0 + 16 + 256) / 8 = 44.5, beside ten values of a normal law, 3 u^4; var(u^2) = (m4 - u^4 * 5/7) / 8.
  const double u4 = std::pow(32.0 / 7, 2), m4 = (8 * 44.5 + 10 * 3 * u4) / 18;
  CHECK(s.u_error == doctest::Approx(std::sqrt((m4 - u4 * 5 / 7) / 8) / (2 * s.u)).epsilon(1e-14));
}

TEST_CASE("the order of the values does not change a bit") {
  std::vector<double> y = sample(999, [](Trial& t) { return t.normal(500, 0.002); });
  const Summary a = summarize(y);
  std::reverse(y.begin(), y.end());
  std::swap(y[3], y[700]);
  const Summary b = summarize(y);
  CHECK(a.mean == b.mean);
  CHECK(a.u == b.u);
  CHECK(a.u_error == b.u_error);
  CHECK(a.low_error == b.low_error);
}

TEST_CASE("equal values have exactly no spread") {
  const std::vector<double> y(1000, 0.1);
  const Summary s = summarize(y);
  CHECK(s.mean == 0.1);
  CHECK(s.u == 0);
  CHECK(s.u_error == 0);
  CHECK(s.low_error == 0);
  CHECK(s.symmetric.low == 0.1);
}

TEST_CASE("an outermost value is known no better than that of a normal law") {
  // All 20 values at an end are equal, and the next one beyond the sample is not seen. The quantile p = 0.5 / 40 of a
  // normal law has the standard error u sqrt(p (1 - p) / n) / phi(z), z = -2.2414: 0.543 u.
  std::vector<double> sample(40, 1.0);
  std::fill_n(sample.begin(), 20, -1.0);
  const Summary s = summarize(sample);
  const double p = 0.5 / 40, z = -2.2414, density = std::exp(-z * z / 2) / std::sqrt(2 * std::acos(-1.0));
  CHECK(s.low_error == doctest::Approx(s.u * std::sqrt(p * (1 - p) / 40) / density).epsilon(0.01));
}

TEST_CASE("fewer than two values have no summary") {
  CHECK_THROWS_AS(summarize(std::vector<double>{1}), InternalError);
  CHECK_THROWS_AS(conformance_probability(std::vector<double>{}, 0.0, 1.0), InternalError);
}

TEST_CASE("limits belong to the conformance zone") {
  const std::vector<double> y{1, 2, 3, 4};
  CHECK(conformance_probability(y, 2.0, 3.0) == 0.5);
  CHECK(conformance_probability(y, {}, 3.0) == 0.75);
  CHECK(conformance_probability(y, 2.0, {}) == 0.75);
  CHECK(conformance_probability(y, {}, {}) == 1);
}

// The standard errors are compared with the scatter of the figures over kRepeats samples. A
// standard deviation from 2000 repeats has a standard error of 1 / sqrt(2 * 1999) = 1.6 %; four of
// them are 6.3 %. The rank band is a difference quotient over the ranks 15.6 ... 34.4 of 1000; for
// a normal sample its expected value is 4 % above the derivative at rank 25, which adds to the
// bound of the limits. False-alarm rate of each comparison: 6e-5.
TEST_CASE("standard errors agree with the scatter of repeated samples") {
  constexpr int kRepeats = 2000, kMachines = 1000;
  std::vector<double> figures[4];
  double mean_square_error[4] = {};
  for (int k = 0; k < kRepeats; ++k) {
    const Summary s = summarize(sample(
        kMachines, [](Trial& t) { return t.normal(); }, 7, static_cast<std::uint32_t>(k * kMachines)));
    const double values[4] = {s.mean, s.u, s.symmetric.low, s.symmetric.high};
    const double errors[4] = {s.mean_error, s.u_error, s.low_error, s.high_error};
    for (int i = 0; i < 4; ++i) {
      figures[i].push_back(values[i]);
      mean_square_error[i] += errors[i] * errors[i] / kRepeats;
    }
  }
  for (int i = 0; i < 4; ++i) {
    CAPTURE(i);
    const double bias = i < 2 ? 0 : 0.04;
    CHECK(std::fabs(std::sqrt(mean_square_error[i]) / summarize(figures[i]).u - 1) <= 4 * 0.0158 + bias);
  }
}

TEST_CASE("numerical tolerance: the examples of JCGM 101 7.9.2") {
  CHECK(numerical_tolerance(0.35, 2) == doctest::Approx(0.005).epsilon(1e-14));
  CHECK(numerical_tolerance(0.35, 1) == doctest::Approx(0.05).epsilon(1e-14));
  CHECK(numerical_tolerance(2.0, 1) == doctest::Approx(0.5).epsilon(1e-14));
  CHECK(numerical_tolerance(0.0996, 2) == doctest::Approx(0.005).epsilon(1e-14));  // reads 0.10 = 10e-2
  CHECK(numerical_tolerance(0.0994, 2) == doctest::Approx(0.0005).epsilon(1e-14));
  CHECK(numerical_tolerance(0, 2) == 0);
}

TEST_CASE("adaptive trials stop when twice the error of every average is within the tolerance") {
  // Two blocks whose u is 2.0: tolerance 0.05 for two digits, so 2 s <= 0.05. For two blocks s =
  // |difference| / 2.
  const auto block = [](double mean, double low) {
    Summary s;
    s.mean = mean, s.u = 2.0, s.symmetric = {low, 4};
    return s;
  };
  AdaptiveTrials near(2), far(2), single(2), low_moves(2);
  single.add(block(500, -4));
  CHECK_FALSE(single.stable());
  near.add(block(500, -4)), near.add(block(500.049, -4));
  CHECK(near.stable());
  far.add(block(500, -4)), far.add(block(500.051, -4));
  CHECK_FALSE(far.stable());
  low_moves.add(block(500, -4)), low_moves.add(block(500, -4.06));
  CHECK_FALSE(low_moves.stable());
  far.add(block(500.025, -4));  // three blocks: s = 0.0255 / sqrt(3)
  CHECK(far.stable());
  CHECK(far.blocks() == 3);
}

TEST_CASE("what does not vary is stable") {
  Summary constant;
  constant.mean = 500, constant.symmetric = {500, 500};
  AdaptiveTrials trials(2);
  trials.add(constant), trials.add(constant);
  CHECK(trials.stable());
}
