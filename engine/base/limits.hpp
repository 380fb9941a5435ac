// What every reader of files takes for a measurement: beyond these a value is a slip, or the mark of a missing one.
#pragma once

namespace abbe {

inline constexpr double kColdest_C = -50, kHottest_C = 150;  ///< of a part, a scale or a room
inline constexpr double kLatest_s = 1e11;                    ///< either side of zero: clocks of the epoch have 2e9

}  // namespace abbe
