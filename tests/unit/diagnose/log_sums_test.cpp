#include "engine/diagnose/model/log_sums.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace abbe::diagnose {

TEST_CASE("sums of exponentials beside a large one, in lanes") {
  const std::vector<double> logs = {0, -1000, 300, 1, -1000, -500, 2, -1000, 300};
  double sums[3];
  log_sums_exp(3, 3, logs.data(), sums);
  CHECK(sums[0] == doctest::Approx(std::log(1 + std::exp(1) + std::exp(2))).epsilon(1e-14));
  CHECK(sums[1] == doctest::Approx(-1000 + std::log(3)).epsilon(1e-14));
  CHECK(sums[2] == doctest::Approx(300 + std::log(2)).epsilon(1e-14));
}

TEST_CASE("a sum of exponentials is as large as its largest") {
  constexpr double kNever = -std::numeric_limits<double>::infinity();
  CHECK(log_sum_exp(std::vector<double>{-800, -800, kNever}) == doctest::Approx(-800 + std::log(2)).epsilon(1e-14));
  CHECK(log_sum_exp(std::vector<double>{700, 0, -700}) == doctest::Approx(700).epsilon(1e-14));
  CHECK(log_sum_exp(std::vector<double>{-0.5}) == -0.5);
  CHECK(std::isnan(log_sum_exp(std::vector<double>{0, std::nan("")})));
}

}  // namespace abbe::diagnose
