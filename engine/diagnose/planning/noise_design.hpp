// The smallest scatter that a recording can tell, from its plan alone.
#pragma once

#include "engine/diagnose/case.hpp"

namespace abbe::diagnose {

/// Appends the effects of the noise to `smallest_detectable`, or, where these touches do not part the groups of one, to
/// `cannot_judge`.
void add_smallest_scatter(const Case&, Diagnosis&);

}  // namespace abbe::diagnose
