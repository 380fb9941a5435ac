// The upper median of a list, for checks on raw data that a single gross error must not spoil.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace abbe::diagnose {

/// The middle value, the upper one of two. The list is not empty.
inline double median(std::vector<double> v) {
  const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
  std::nth_element(v.begin(), middle, v.end());
  return *middle;
}

}  // namespace abbe::diagnose
