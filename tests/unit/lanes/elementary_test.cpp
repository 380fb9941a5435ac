#include "engine/lanes/elementary.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace abbe {

TEST_CASE("sine and cosine of half turns") {
  for (int i = -4000; i <= 4000; ++i) {
    const double u = i * 0.00137;
    const SinCos f = sin_cos_pi(u);
    const double turn = u - 2 * std::round(u / 2);
    CHECK(std::fabs(f.sin - std::sin(3.14159265358979323846 * turn)) < 1e-15);
    CHECK(std::fabs(f.cos - std::cos(3.14159265358979323846 * turn)) < 1e-15);
  }
}

TEST_CASE("quarter turns are exact, however many there are") {
  const double base[] = {0, 4, -8, 1e6, -1e12};
  for (const double u : base) {
    CHECK(sin_cos_pi(u).cos == 1);
    CHECK(sin_cos_pi(u).sin == 0);
    CHECK(sin_cos_pi(u + 0.5).sin == 1);
    CHECK(sin_cos_pi(u + 1).cos == -1);
    CHECK(sin_cos_pi(u + 1.5).sin == -1);
    CHECK(sin_cos_pi(u + 1.5).cos == 0);
  }
}

TEST_CASE("the logarithm of positive numbers") {
  for (double x = 1e-300; x < 1e300; x *= 1.37) CHECK(log_positive(x) == doctest::Approx(std::log(x)).epsilon(1e-15));
  for (double x = 0.5; x < 1.5; x += 0.000917) CHECK(std::fabs(log_positive(x) - std::log(x)) < 1.2e-16);
  CHECK(log_positive(1) == 0);
}

}  // namespace abbe
