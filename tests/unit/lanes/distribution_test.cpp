#include "engine/lanes/distribution.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/lanes/elementary.hpp"
#include "engine/lanes/random.hpp"

using namespace abbe;
using enum abbe::Distribution;

namespace {

constexpr int kDraws = 400'000;

std::vector<double> draws(const Deviation& d) {
  std::vector<double> x;
  for (std::uint32_t m = 0; m < kDraws; ++m)
    x.push_back(deviation(d, uniform_pair({7, m, stream_of("test"), 0, 0, 0})));
  return x;
}

double share_below(const std::vector<double>& x, double limit) {
  return static_cast<double>(std::count_if(x.begin(), x.end(), [&](double v) { return v <= limit; })) /
      static_cast<double>(x.size());
}

/// Six standard errors of a share: false alarm 2e-9.
void check_share(const std::vector<double>& x, double limit, double expected) {
  CAPTURE(limit);
  CHECK(std::fabs(share_below(x, limit) - expected) < 6 * std::sqrt(expected * (1 - expected) / kDraws));
}

}  // namespace

TEST_CASE("the exponential function agrees with libm to two units in the last place") {
  for (double x = -690; x < 690; x += 0.37) CHECK(std::fabs(exp_bounded(x) / std::exp(x) - 1) < 4.5e-16);
  CHECK(exp_bounded(0) == 1);
}

TEST_CASE("every distribution has its mean and its standard deviation") {
  // Six standard errors; kurtosis up to 6 for t with 8 degrees of freedom and more. False alarm
  // below 1e-7 in all.
  for (const Deviation& d :
       {Deviation{normal, 2, 0}, Deviation{student_t, 2, 8}, Deviation{rectangular, 3, 0}, Deviation{triangular, 3, 0},
        Deviation{arcsine, 0.5, 0}, Deviation{trapezoidal, 2, 0.4}, Deviation{curvilinear_trapezoid, 0.05, 0.025}}) {
    CAPTURE(static_cast<int>(d.distribution));
    double sum = 0, squares = 0;
    for (const double x : draws(d)) sum += x, squares += x * x;
    const double sd = standard_deviation(d);
    CHECK(std::fabs(sum / kDraws) < 6 * sd / std::sqrt(kDraws));
    CHECK(std::fabs(squares / kDraws / (sd * sd) - 1) < 6 * std::sqrt(5.0 / kDraws));
  }
}

TEST_CASE("quantiles of tables are met") {
  // t(0.975) with 5 degrees of freedom 2.570582, with 18 2.100922 (tables of Student's t);
  // normal 1.959964.
  check_share(draws({student_t, 1, 5}), 2.570582, 0.975);
  check_share(draws({student_t, 10, 18}), 21.00922, 0.975);
  check_share(draws({normal, 1, 0}), 1.959964, 0.975);
  // Rectangle: linear. Triangle: F(1/2) = 7/8. Arcsine: F(sin 60 deg) = 5/6. Trapezoid, top half of
  // the base: flat top 2/3 of all.
  check_share(draws({rectangular, 1, 0}), 0.9, 0.95);
  check_share(draws({triangular, 1, 0}), 0.5, 0.875);
  check_share(draws({arcsine, 1, 0}), std::sqrt(0.75), 5.0 / 6);
  check_share(draws({trapezoidal, 1, 0.5}), 0.5, 0.5 + 1.0 / 3);
  // Curvilinear trapezoid, half width 1 +- 0.5: for |x| <= 0.5 the density is ln(1.5 / 0.5) / (4 *
  // 0.5), JCGM 101 6.4.3.2.
  check_share(draws({curvilinear_trapezoid, 1, 0.5}), 0.5, 0.5 + 0.5 * std::log(3.0) / 2);
}

TEST_CASE("limits hold, and a width can be given by its standard deviation") {
  for (const Deviation& d : {Deviation{rectangular, 3, 0}, Deviation{triangular, 3, 0}, Deviation{arcsine, 3, 0},
                             Deviation{trapezoidal, 3, 0.4}})
    for (const double x : draws(d)) REQUIRE(std::fabs(x) <= 3);
  for (const double x : draws({curvilinear_trapezoid, 3, 1})) REQUIRE(std::fabs(x) <= 4);
  for (const Distribution kind : {rectangular, triangular, arcsine, trapezoidal, curvilinear_trapezoid})
    CHECK(standard_deviation({kind, half_width_for(kind, 0.3, 2), 0.3}) == doctest::Approx(2).epsilon(1e-14));
  CHECK(half_width_for(rectangular, 0, 1) == doctest::Approx(std::sqrt(3.0)));
  CHECK(half_width_for(curvilinear_trapezoid, 9, 1) == 0);
}
