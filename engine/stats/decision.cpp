#include "engine/stats/decision.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "engine/base/ids.hpp"

namespace abbe {

namespace {

/// The fewest of `n` errors whose share is at least the probability.
int fewest(int n, double probability) {
  constexpr double kRounding = 1e-9;  // 0.95 * n may come out above a whole number
  return std::max(1, static_cast<int>(std::ceil(probability * n - kRounding)));
}

/// The least distance that `enough` of the intervals from_i ... to_i + `tolerance` hold; without a tolerance they have no
/// end. None: nowhere.
std::optional<double> least_held(std::span<const double> from, std::span<const double> to, double sign,
                                 std::optional<double> tolerance, int enough) {
  std::vector<double> begins, ends;
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (tolerance && sign * from[i] - sign * to[i] > *tolerance) continue;  // holds nothing
    begins.push_back(sign * from[i]), ends.push_back(sign * to[i]);
  }
  std::sort(begins.begin(), begins.end());
  std::sort(ends.begin(), ends.end());
  std::size_t ended = 0;
  for (std::size_t k = 0; k < begins.size(); ++k) {
    while (tolerance && begins[k] - ends[ended] > *tolerance) ++ended;
    if (static_cast<int>(k + 1 - ended) >= enough) return begins[k];
  }
  return std::nullopt;
}

}  // namespace

Conformity decide(double y, const JudgedSample& errors, std::optional<double> lower, std::optional<double> upper,
                  double probability) {
  const auto share_inside = [&](double sign) {
    std::vector<double> by_lower(errors.by_lower.begin(), errors.by_lower.end()),
        by_upper(errors.by_upper.begin(), errors.by_upper.end());
    for (double& v : by_lower) v = y + sign * v;
    for (double& v : by_upper) v = y + sign * v;
    return conformance_probability({by_lower, by_upper}, lower, upper);
  };
  const auto [least, most] = std::minmax({share_inside(1), share_inside(-1)});
  if (least >= probability) return Conformity::conforms;
  const bool outside = (lower && y < *lower) || (upper && y > *upper);
  return outside && most <= 1 - probability ? Conformity::does_not_conform : Conformity::undecided;
}

std::optional<double> guard_band(const JudgedSample& errors, std::optional<double> lower, std::optional<double> upper,
                                 double probability) {
  ABBE_CHECK(errors.size() > 0);
  const std::optional<double> tolerance = lower && upper ? std::optional(*upper - *lower) : std::nullopt;
  const int enough = fewest(static_cast<int>(errors.size()), probability);
  double guard = 0;
  for (const double sign : {1.0, -1.0}) {
    const auto at_upper = least_held(errors.by_upper, errors.by_lower, sign, tolerance, enough),
               at_lower = least_held(errors.by_lower, errors.by_upper, -sign, tolerance, enough);
    if ((upper && !at_upper) || (lower && !at_lower)) return std::nullopt;
    if (upper) guard = std::max(guard, *at_upper);
    if (lower) guard = std::max(guard, *at_lower);
  }
  return tolerance && 2 * guard > *tolerance ? std::nullopt : std::optional(guard);
}

}  // namespace abbe
