#include "engine/stats/decision.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/base/ids.hpp"
#include "engine/stats/summary.hpp"

namespace abbe {

namespace {

/// The fewest of `n` errors whose share is at least the probability.
int fewest(int n, double probability) {
  constexpr double kRounding = 1e-9;  // 0.95 * n may come out above a whole number
  return std::max(1, static_cast<int>(std::ceil(probability * n - kRounding)));
}

}  // namespace

Conformity decide(double y, std::span<const double> errors, std::optional<double> lower, std::optional<double> upper,
                  double probability) {
  const auto share_inside = [&](double sign) {
    std::vector<double> values(errors.begin(), errors.end());
    for (double& v : values) v = y + sign * v;
    return conformance_probability(values, lower, upper);
  };
  const auto [least, most] = std::minmax({share_inside(1), share_inside(-1)});
  if (least >= probability) return Conformity::conforms;
  const bool outside = (lower && y < *lower) || (upper && y > *upper);
  return outside && most <= 1 - probability ? Conformity::does_not_conform : Conformity::undecided;
}

std::optional<double> guard_band(std::span<const double> errors, std::optional<double> lower,
                                 std::optional<double> upper, double probability) {
  ABBE_CHECK(!errors.empty());
  std::vector<double> e(errors.begin(), errors.end());
  std::sort(e.begin(), e.end());
  const bool both = lower && upper;
  const double tolerance = both ? *upper - *lower : 0;
  const int m = fewest(static_cast<int>(e.size()), probability);
  const int rows = static_cast<int>(e.size()) - m + 1;
  const auto fits = [&](int j) { return !both || e[j + m - 1] - e[j] <= tolerance; };
  int first = 0, last = rows - 1;
  while (first < rows && !fits(first)) ++first;
  if (first == rows) return std::nullopt;
  while (!fits(last)) --last;
  const double guard = std::max(e[first + m - 1], -e[last]);
  return both && 2 * guard > tolerance ? std::nullopt : std::optional(guard);
}

}  // namespace abbe
