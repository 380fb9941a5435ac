// What the effects of a machine file did in a run.
#pragma once

#include <cstddef>
#include <vector>

namespace abbe {

struct EffectActivity {
  bool moved = false;   ///< it has moved a touch along its normal by more than rounding
  bool beyond = false;  ///< a touch lay where it only prolongs what it was fitted to (Effect::beyond)
};
/// By effect of the machine file.
using EffectActivities = std::vector<EffectActivity>;

/// Joins those of some machines to those of others, of the same machine file.
inline void add_activities(const EffectActivities& of_some, EffectActivities& of_all) {
  for (std::size_t k = 0; k < of_all.size(); ++k) {
    of_all[k].moved |= of_some[k].moved;
    of_all[k].beyond |= of_some[k].beyond;
  }
}

}  // namespace abbe
