// The clock of a recording: another beginning, or a new day.
#pragma once

#include <string>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/recording/recording.hpp"

namespace abbe::diagnose {

/// A recording whose clock of the day falls back at midnight, with times that go on (N0727): what comes later in the file
/// stands more than half a day before what comes first.
void continue_past_midnight(Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// A recording whose clock began long before its first touch, with times from that touch on (N0721).
void count_from_first_touch(Recording&, const std::string& file, std::vector<Diagnostic>& messages);

}  // namespace abbe::diagnose
