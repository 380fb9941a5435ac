// Repeats that nobody numbered.
#pragma once

#include <string>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/recording/recording.hpp"

namespace abbe::diagnose {

/// A recording in which a run of a setup holds all its touches several times, in the same order, with each time as a run of its own
/// (N0708): else what is new in the repeat would have begun in the middle of a run. The numbers of runs after it count on. A
/// few touches that come again, as those of a ball that is looked at now and then, are no repeat, nor are copies of rows.
void number_repeats(Recording&, const std::string& file, std::vector<Diagnostic>& messages);

}  // namespace abbe::diagnose
