// Whether a periodic error of a scale can be told from something that depends on the direction of the touch alone.
#pragma once

#include "engine/diagnose/findings/search.hpp"

namespace abbe::diagnose {

/// Whether an effect of raw readings is a function of the normal in this recording: wherever two places were touched in
/// the same direction, the readings were at the same phase. Balls at round heights, all touched alike, do that.
bool same_phase_in_same_direction(const Case&, const Finding&);

}  // namespace abbe::diagnose
