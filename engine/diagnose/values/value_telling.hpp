// The words and figures of what a diagnosis of values has found.
#pragma once

#include "engine/diagnose/values/value_estimate.hpp"

namespace abbe::diagnose {

/// Of the variant of a finding, with 95 % intervals.
std::vector<DiagnosedParameter> parameters_of(const ValueCase&, const Closer&, const Finding&);

/// A set of names. `adequacy`: how often a machine with the first leaves as much as the recording does.
void tell_name(const ValueCase&, const Closer&, const Finding&, double adequacy, Diagnosis&);

/// What stands for no name.
void tell_pattern(const ValueCase&, const Closer&, const Finding&, Diagnosis&);

}  // namespace abbe::diagnose
