#include "engine/diagnose/findings/noise/scatter.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "engine/diagnose/model/noise_law.hpp"
#include "engine/lanes/random.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

constexpr std::uint32_t kScatterStream = stream_of("test.scatter");
constexpr Eigen::Index kScattered = 400;

/// The first half scatters by this ratio more than the second.
Excess excess_of(double ratio, int replicate) {
  Vector share = Vector::Zero(kScattered), r = NoiseLaw().simulated(kScattered, 3, kScatterStream, replicate);
  share.head(kScattered / 2).setOnes();
  r.head(kScattered / 2) *= ratio;
  return excess_along({r, 1, 1, Matrix::Identity(kScattered, kScattered)}, share);
}

}  // namespace

TEST_CASE("scatter that is equal seems unequal as often as is said, and scatter that is not is found") {
  constexpr int kMany = 1000;
  int alarms = 0;
  double size = 0;
  for (int k = 0; k < kMany; ++k) alarms += chance_of_excess(excess_of(1, k).chi2) <= 0.05;
  for (int k = 0; k < 100; ++k) size += excess_of(2, k).size / 100;
  // 50 expected; outside 30 to 71 once in 400 times
  CHECK(alarms >= 30);
  CHECK(alarms <= 71);
  CHECK(size == doctest::Approx(3).epsilon(0.1));  // variances 4 and 1
}

TEST_CASE("the chances of unequal scatter and of outliers are those of their laws") {
  CHECK(chance_of_excess(3.841) == doctest::Approx(0.025).epsilon(0.001));
  CHECK(chance_of_excess(0) == 0.5);
  // Squares of a ratio of relative uncertainty 1 / sqrt(2 nu) are chi-squared / nu: its 5 % and 0.1 % points.
  const auto chance = [](double nu, double point) {
    return chance_of_ratio(kLeastExcess * std::sqrt(point / nu), 1 / std::sqrt(2 * nu));
  };
  CHECK(chance(20, 31.410) == doctest::Approx(0.05).epsilon(0.02));
  CHECK(chance(20, 45.315) == doctest::Approx(0.001).epsilon(0.05));
  CHECK(chance(200, 233.994) == doctest::Approx(0.05).epsilon(0.02));
  CHECK(chance_of_ratio(10, 0.25) < 1e-6);  // ten times the scatter shows in ten touches
  CHECK(poisson_tail(2, 0.01) == doctest::Approx(1 - 1.01 * std::exp(-0.01)).epsilon(1e-9));
  CHECK(poisson_tail(0, 3) == doctest::Approx(1));
  CHECK(poisson_tail(4, 3) == doctest::Approx(1 - 13 * std::exp(-3)));
  CHECK(poisson_tail(40, 14) < 2e-8);
  CHECK(poisson_tail(2, 14) == doctest::Approx(1 - 15 * std::exp(-14)));  // fewer than expected are no alarm
  CHECK(poisson_tail(2, 1e12) == 1);
}

TEST_CASE("a sum of squares varies more where tails are heavy or residuals have much in common") {
  const Vector all = Vector::Ones(kScattered);
  const Matrix apart = Matrix::Identity(kScattered, kScattered), one = Matrix::Ones(kScattered, kScattered);
  CHECK(inflation(1, apart, all) == doctest::Approx(1));
  CHECK(inflation(2.5, apart, all) == doctest::Approx(2.5));
  CHECK(inflation(1, one, all) == doctest::Approx(double(kScattered)));
}
