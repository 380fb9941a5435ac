// Which measurement would decide between explanations that a recording cannot tell apart.
//
// A change of the menu makes a second recording out of the first one: its rows, repeated another way (other
// speed, other stylus, part turned, ...). Both together go through the same steps as any recording: scenes,
// baseline with the same unknowns, signatures. So what is proposed can be recorded, and it is judged with
// what will be unknown then (sizes nobody calibrated, placements, qualifications of new styli).
//
// Each rival in turn counts as the truth, of the size that the first recording gives it. With W the columns
// of another rival, whitened by the baseline, the truth's shift s leaves delta = min |s - W b|^2 that the
// other cannot imitate, over its variants. What the second recording adds, D = delta(both) - delta(first),
// makes the log odds of the truth normal with mean D / 2 and variance D. The expected probability of the
// truth follows, averaged over the rivals as truth: what a recording cannot tell apart counts as equally
// likely (Atkinson & Fedorov, Biometrika 62, 1975). Where no single change decides, the best ones are
// tried two at a time. Ranked by gain per minute, a round of an hour included.
#pragma once

#include <vector>

#include "engine/diagnose/findings/search.hpp"

namespace abbe::diagnose {

/// The changes that would tell most per minute, the best of them as a program. `found`: what the recording holds;
/// none of a plan.
std::vector<NextMeasurement> next_measurements(const Case&, const SearchResult* found, const std::vector<Detectable>&);

}  // namespace abbe::diagnose
