// What the effects of a machine file did in a run.
#pragma once

#include <vector>

namespace abbe {

struct EffectActivity {
  bool moved = false;   ///< it has moved a touch along its normal by more than rounding
  bool beyond = false;  ///< a touch lay where it only prolongs what it was fitted to (Effect::beyond)
};
/// By effect of the machine file.
using EffectActivities = std::vector<EffectActivity>;

/// Joins those of some machines to those of others, of the same machine file.
void add_activities(const EffectActivities& of_some, EffectActivities& of_all);

}  // namespace abbe
