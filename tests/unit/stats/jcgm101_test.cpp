// The examples of JCGM 101:2008, clause 9, and conformity risks, recomputed from Monte Carlo
// samples.
//
// Every bound is kSigmas standard errors of the figure at the number of trials used, plus half a
// unit of the last printed digit where the expected value is a published, rounded one. kSigmas = 4
// gives each comparison a false-alarm rate of 6e-5 over seeds; there are about 40 comparisons, so a
// change of the random numbers trips this file once in 400 times. The seeds are fixed.
#include <doctest/doctest.h>

#include "draws.hpp"
#include "engine/stats/summary.hpp"

using namespace abbe;
using namespace abbe::test;

namespace {

constexpr double kSigmas = 4;
constexpr int kTrials = 1'000'000;

void check_near(double found, double expected, double standard_error, double rounding = 0) {
  CAPTURE(found);
  CAPTURE(expected);
  CAPTURE(standard_error);
  CHECK(std::fabs(found - expected) <= kSigmas * standard_error + rounding);
}

double quantile_error(double p, double density) { return std::sqrt(p * (1 - p) / kTrials) / density; }

/// A sample whose 97.5 % quantile, density there, u and excess of kurtosis are known.
void check_symmetric_about_zero(const Summary& s, double u, double excess, double quantile, double density) {
  check_near(s.mean, 0, u / std::sqrt(kTrials));
  check_near(s.u, u, u * std::sqrt((2 + excess) / (4.0 * kTrials)));
  check_near(s.symmetric.low, -quantile, quantile_error(0.025, density));
  check_near(s.symmetric.high, quantile, quantile_error(0.025, density));
}

void check_four_rectangular(const FourRectangular& exact, double published_limit, double half_digit) {
  double variance = 0, fourth = 0;
  for (const double a : exact.a)
    variance += a * a / 3, fourth += -2 * std::pow(a, 4) / 15;  // kurtosis: a^4/5 - 3 (a^2/3)^2
  const double limit = exact.quantile(0.975);
  CHECK(std::fabs(limit - published_limit) <= half_digit);
  const Summary s = summarize(sample(kTrials, [&](Trial& t) {
    double sum = 0;
    for (const double a : exact.a) sum += t.rectangular(-a, a);
    return sum;
  }));
  check_symmetric_about_zero(s, std::sqrt(variance), fourth / (variance * variance), limit, exact.density(limit));
}

}  // namespace

TEST_CASE("JCGM 101 9.2.2: the sum of four normal variables") {
  const Summary s =
      summarize(sample(kTrials, [](Trial& t) { return t.normal() + t.normal() + t.normal() + t.normal(); }));
  const double z = 1.959963984540054;
  check_symmetric_about_zero(s, 2, 0, 2 * z, normal_density(z) / 2);
  CHECK(s.symmetric.high == doctest::Approx(3.92).epsilon(0.01));  // as printed
  CHECK(s.shortest.high - s.shortest.low <= s.symmetric.high - s.symmetric.low);
}

TEST_CASE("JCGM 101 9.2.3: the sum of four rectangular variables") {
  const double a = std::sqrt(3.0);
  check_four_rectangular({{a, a, a, a}}, 3.88, 0.005);
}

TEST_CASE("JCGM 101 9.2.4: one rectangular variable ten times wider") {
  const double a = std::sqrt(3.0);
  check_four_rectangular({{a, a, a, 10 * a}}, 17.0, 0.05);
}

TEST_CASE("JCGM 101 9.3: mass calibration, where first-order propagation gives u = 0.054") {
  const Summary s = summarize(sample(kTrials, [](Trial& t) {
    const double m_r = t.normal(100'000, 0.050), dm_r = t.normal(1.234, 0.020);
    const double rho_a = t.rectangular(1.10, 1.30), rho_w = t.rectangular(7000, 9000),
                 rho_r = t.rectangular(7950, 8050);
    return (m_r + dm_r) * (1 + (rho_a - 1.2) * (1 / rho_w - 1 / rho_r)) - 100'000;
  }));
  check_near(s.mean, 1.2340, s.mean_error, 0.00005);
  check_near(s.u, 0.0755, s.u_error, 0.00005);
  check_near(s.shortest.low, 1.084, s.low_error, 0.0005);
  check_near(s.shortest.high, 1.383, s.high_error, 0.0005);
}

TEST_CASE("JCGM 101 9.5: gauge block calibration") {
  const auto lengths_nm = sample(kTrials, [](Trial& t) {
    const double ls = t.student(18, 50'000'623, 25);
    const double d = t.student(24, 215, 6) + t.student(5, 0, 4) + t.student(8, 0, 7);
    const double alpha_s = t.rectangular(9.5e-6, 13.5e-6);
    const double theta = t.normal(-0.1, 0.2) + t.arc_sine(-0.5, 0.5);
    const double d_alpha = t.curvilinear_trapezoid(-1e-6, 1e-6, 0.1e-6);
    const double d_theta = t.curvilinear_trapezoid(-0.050, 0.050, 0.025);
    return ls + d - ls * (d_alpha * theta + alpha_s * d_theta) - 50'000'000;
  });
  const Summary s = summarize(lengths_nm, 0.99);
  check_near(s.mean, 838.0, s.mean_error, 0.05);
  check_near(s.u, 35.8, s.u_error, 0.05);
  check_near(s.shortest.low, 744, s.low_error, 0.5);
  check_near(s.shortest.high, 931, s.high_error, 0.5);
  check_near(s.symmetric.low, 744.4, s.low_error, 0.05);
  check_near(s.symmetric.high, 931.7, s.high_error, 0.05);
}

TEST_CASE("specific risk is one minus the conformance probability") {
  struct Case {
    double mean, risk;
  };
  for (const Case c : {Case{10, 0.01242}, Case{10.5, 0.10574}, Case{12, 0.99379}}) {
    const auto y = sample(kTrials, [&](Trial& t) { return t.normal(c.mean, 0.4); });
    check_near(1 - conformance_probability(y, 9, 11), c.risk, std::sqrt(c.risk * (1 - c.risk) / kTrials), 0.000005);
  }
}

TEST_CASE("a one-sided guard band of k u leaves the risk of a normal tail") {
  struct Case {
    double k, risk, half_digit;
  };
  for (const Case c :
       {Case{0, 0.50, 0}, Case{1, 0.1587, 0.00005}, Case{1.645, 0.0500, 0.00005}, Case{2, 0.02275, 0.000005}}) {
    const auto y = sample(kTrials, [&](Trial& t) { return t.normal(10 - c.k * 0.3, 0.3); });
    const double error = std::sqrt(c.risk * (1 - c.risk) / kTrials);
    check_near(1 - conformance_probability(y, {}, 10.0), c.risk, error, c.half_digit);
    check_near(conformance_probability(y, 10.0, {}), c.risk, error, c.half_digit);
  }
}
