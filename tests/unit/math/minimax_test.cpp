#include "engine/math/minimax.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <vector>

using namespace abbe;
using doctest::Approx;

namespace {

/// Some number in (-1, 1), the same one for the same i (the finaliser of SplitMix64).
double uniform(std::uint64_t i) {
  std::uint64_t z = (i + 1) * 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
}

template <int N>
double largest(const std::vector<MinimaxRow<N>>& rows, const double (&x)[N]) {
  double worst = -1e300;
  for (const auto& row : rows) {
    double f = row.f;
    for (int k = 0; k < N; ++k) f += row.g[k] * x[k];
    worst = std::max(worst, f);
  }
  return worst;
}

}  // namespace

TEST_CASE("The Chebyshev line through three points") {
  // |y - a - b t| for (0,0), (1,1), (2,0): a = 0.5, b = 0, error 0.5.
  std::vector<MinimaxRow<2>> rows;
  for (const auto& [t, y] : {std::pair{0.0, 0.0}, {1.0, 1.0}, {2.0, 0.0}})
    for (const double sign : {1.0, -1.0}) rows.push_back({sign * y, {-sign, -sign * t}});
  double x[2];
  CHECK(minimax_in_box<2>(rows, x) == Approx(0.5));
  CHECK(x[0] == Approx(0.5));
  CHECK(x[1] == Approx(0.0));
}

TEST_CASE("The box holds what the functions do not") {
  const std::vector<MinimaxRow<2>> one = {{3, {2, -1}}};
  double x[2];
  CHECK(minimax_in_box<2>(one, x) == Approx(0));
  CHECK(x[0] == -1);
  CHECK(x[1] == 1);
}

TEST_CASE("No point of the box is better than the optimum") {
  std::uint64_t draw = 0;
  for (int problem = 0; problem < 40; ++problem) {
    std::vector<MinimaxRow<3>> rows(static_cast<std::size_t>(4 + problem % 17));
    for (auto& row : rows) {
      row.f = uniform(draw++);
      for (double& g : row.g) g = uniform(draw++);
    }
    double best[3];
    const double value = minimax_in_box<3>(rows, best);
    CHECK(largest(rows, best) == Approx(value));
    for (int trial = 0; trial < 200; ++trial) {
      double x[3];
      for (int k = 0; k < 3; ++k) {
        const double anywhere = uniform(draw++);
        x[k] = trial % 2 ? anywhere : std::clamp(best[k] + 0.01 * anywhere, -1.0, 1.0);
      }
      CHECK(largest(rows, x) >= value - 1e-12);
    }
  }
}
