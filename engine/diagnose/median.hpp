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

/// How far nine touches in ten lie from their targets at most. `off_mm`: of every touch; not empty.
inline double nine_tenths(std::vector<double> off_mm) {
  const auto at = off_mm.begin() + static_cast<std::ptrdiff_t>(0.9 * double(off_mm.size()));
  std::nth_element(off_mm.begin(), at, off_mm.end());
  return *at;
}
/// Where half of the touches, or a tenth, lie further out, the targets are not those of the part: no machine, and no effect, does so much.
/// A tenth too, because a placement is found where most of them lie well: the faces of a part may, and its bores not.
inline constexpr double kBeyondMachines_mm = 0.1, kBeyondEffects_mm = 1.25;

}  // namespace abbe::diagnose
