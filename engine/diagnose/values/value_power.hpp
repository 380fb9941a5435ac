// From which size on values show an effect. On a machine without errors a form shows any; beside errors it hides what is
// smaller than they are. So machines that have the effect say what is seen.
#pragma once

#include <vector>

#include "engine/diagnose/values/value_case.hpp"

namespace abbe::diagnose {

/// Of each effect of the catalogue that some possible size makes seen in kPowerShare of recordings, in the form (axis,
/// phase) in the middle. `in_order`: what the search says of machines in order.
std::vector<Detectable> smallest_detectable(const ValueCase&, std::vector<double> in_order);

}  // namespace abbe::diagnose
