// Which explanation of recorded values is told: a name, or what stands for none.
#pragma once

#include "engine/diagnose/values/value_estimate.hpp"

namespace abbe::diagnose {

/// Tells a set of names with a possible size, where it is likelier than a pattern and leaves no more than chance does; else
/// a pattern. Beside it stands whether that predicts values that it was not fitted to.
void tell_explanation(const ValueCase&, const Closer&, Diagnosis&);

}  // namespace abbe::diagnose
