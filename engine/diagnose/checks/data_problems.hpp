// Recordings that no physics explains: another unit, swapped axes, one value in all rows, rows twice. Each is
// recognised by what would mend it, and said instead of being diagnosed.
#pragma once

#include <string>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/machine/machine.hpp"
#include "engine/recording/recording.hpp"

namespace abbe::diagnose {

/// A recording without its exact copies of rows. Throws UserError: one touch with two values, a copied run (E0713).
Recording without_copies(const Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// Throws UserError: a touch without target or normal (E0543), another unit or other axes.
void check_data(const Recording&, const Machine&, const std::string& file);

}  // namespace abbe::diagnose
