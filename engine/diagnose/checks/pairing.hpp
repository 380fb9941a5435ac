// Touches that are paired with the wrong targets: a row of another feature, numbers that count from another
// touch. Labels and numbers agree then, but not the places. What a machine and a part do to a touch lies
// along the normal; beside its target it is only as far as the part was not aligned.
#pragma once

#include <string>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/recording/recording.hpp"
#include "engine/run/recorded/touch.hpp"

namespace abbe::diagnose {

/// Throws UserError when many touches lie beside their targets; a few are warned of.
void check_pairing(const Recording&, const RecordedTouches&, const std::string& file,
                   std::vector<Diagnostic>& messages);
/// Throws UserError (E0701) when all touches of one feature lie a tip's radius or diameter too far out or in.
void check_tips(const RecordedTouches&, const std::string& file);
/// Takes rows out that are their targets to the last digit where the others are not, and more of them than rounding makes
/// so: nobody measured these (W0717). Where all are, nothing is taken out.
void leave_out_targets(Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// Takes rows out that lie so far from their targets that they are no touches of these (W0712). Throws UserError (E0711) when
/// they are many.
void leave_out_astray(Recording&, const std::string& file, std::vector<Diagnostic>& messages);

}  // namespace abbe::diagnose
