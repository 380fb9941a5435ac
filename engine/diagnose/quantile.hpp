// Quantiles of a list: a single gross error does not spoil them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace abbe::diagnose {

/// The value that this share of a list lies below. The list is not empty; 0 <= share < 1.
inline double quantile(std::vector<double> v, double share) {
  const auto at = v.begin() + static_cast<std::ptrdiff_t>(share * double(v.size()));
  std::nth_element(v.begin(), at, v.end());
  return *at;
}

/// The middle value, the upper one of two. The list is not empty.
inline double median(std::vector<double> v) { return quantile(std::move(v), 0.5); }

}  // namespace abbe::diagnose
