#include "engine/diagnose/model/log_sums.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace abbe::diagnose {

double log_sum_exp(std::span<const double> v) {
  std::vector<double> shares(v.size());
  const double top = *std::max_element(v.begin(), v.end());
  for_lanes(static_cast<int>(v.size()),
            [top, v = v.data(), shares = shares.data()](int i) { shares[i] = exp_of_share(v[i] - top); });
  return top + std::log(std::accumulate(shares.begin(), shares.end(), 0.0));
}

double log_sum_exp(const Vector& v) { return log_sum_exp(std::span(v.data(), static_cast<std::size_t>(v.size()))); }

void log_sums_exp(int rows, int lanes, const double* logs, double* sums) {
  std::vector<double> top(static_cast<std::size_t>(lanes));
  on_lanes([=, top = top.data()] { log_sums_exp(rows, lanes, logs, top, sums); });
}

}  // namespace abbe::diagnose
