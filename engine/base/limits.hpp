// What every reader of files takes for a measurement: beyond these a value is a slip, or the mark of a missing one.
#pragma once

#include "engine/base/json_reader.hpp"

namespace abbe {

inline constexpr double kColdest_C = -50, kHottest_C = 150;  ///< of a part, a scale or a room
inline constexpr double kLatest_s = 1e11;                    ///< either side of zero: clocks of the epoch have 2e9
inline constexpr NumberRange kTurn_deg{-360, 360, true, true, "between -360 and 360"};
// Of machines, heads and styli: none is longer than 100 m.
inline constexpr NumberRange kLength_mm{0, 1e5, false, true, "greater than 0 and at most 100000"};
inline constexpr NumberRange kDistance_mm{0, 1e5, true, true, "between 0 and 100000"};
inline constexpr NumberRange kCoordinate_mm{-1e5, 1e5, true, true, "between -100000 and 100000"};
// Beyond every material of a shaft and every probe and head: who gives MPa, nm or turns is told.
inline constexpr NumberRange kYoung_GPa{0, 2000, false, true, "greater than 0 and at most 2000"};
inline constexpr NumberRange kCte_ppm_per_K{-100, 1000, true, true, "between -100 and 1000"};
inline constexpr NumberRange kProbeSd_um{0, 1000, true, true, "between 0 and 1000"};
inline constexpr NumberRange kIndexingSd_arcsec{0, 3600, true, true, "between 0 and 3600"};

}  // namespace abbe
