// What the number of a parameter stands for, where that has a name.
#pragma once

#include <string>
#include <vector>

#include "engine/effects/effect.hpp"
#include "engine/run/recorded/touch.hpp"

namespace abbe::diagnose {

/// The stylus of that number, or the tip in its orientation; "" of any other parameter or number.
std::string called(const EffectParameter&, int number, const RecordedTouches&);
/// The word of a choice; a name as above, "all" for 0 of what could have one, "none" for 0 of a speed; "" of a number that is told as such.
std::string word_of(const EffectParameter&, double value, const RecordedTouches&);
/// Whether a parameter counts beside the values of the others: a moment where a step is along time.
bool counts(const Effect&, const EffectParameter&, const std::vector<double>& theta);

}  // namespace abbe::diagnose
