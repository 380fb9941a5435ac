// Whether what was told of recorded values predicts others that it was not fitted to.
#pragma once

#include "engine/diagnose/values/value_estimate.hpp"

namespace abbe::diagnose {

/// Grouped leave-one-out of the explanation of a finding (findings/improvement.cpp has the formula). The point near
/// which a variant is linear is that of all values. Nothing is told where all values are of one group.
void show_improvement(const ValueCase&, const Closer&, const Finding&, Diagnosis&);

}  // namespace abbe::diagnose
