// Columns of a recording that say less than they seem to: gaps, or values of another unit.
#pragma once

#include <string>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/machine/machine.hpp"
#include "engine/recording/recording.hpp"

namespace abbe::diagnose {

/// A recording without what was logged in some rows only: what is missing would be taken for its usual value, beside
/// what was logged (W0722).
void leave_out_partly_logged(Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// Warns of temperatures that no measuring room has (W0724).
void doubt_temperatures(const Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// Warns of speeds, accelerations and clocks that no machine has (W0728).
void doubt_motion(const Recording&, const std::string& file, std::vector<Diagnostic>& messages);

/// Takes head angles out that are the same in all rows although the styli are described in several orientations (W0736).
void leave_out_head_at_rest(Recording&, const Machine&, const std::string& file, std::vector<Diagnostic>& messages);

}  // namespace abbe::diagnose
