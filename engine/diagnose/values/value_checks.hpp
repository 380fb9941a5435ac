// What is wrong with a file of values as such.
#pragma once

#include "engine/diagnose/values/value_case.hpp"

namespace abbe::diagnose {

/// Calibrations that say less of most values than any machine of the specification would.
void doubt_calibrations(const ValueCase&, std::vector<Diagnostic>& messages);

/// Whether every value is, to its last digit, what it should be. Machines of the specification would not report that: the
/// chance is the digit times the density of the values.
bool holds_references_only(const ValueCase&);

}  // namespace abbe::diagnose
