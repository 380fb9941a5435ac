// What the number of a parameter stands for, where that has a name.
#pragma once

#include <string>

#include "engine/effects/effect.hpp"
#include "engine/run/recorded/touch.hpp"

namespace abbe::diagnose {

/// The stylus of that number, or the tip in its orientation; "" of any other parameter or number.
std::string called(const EffectParameter&, int number, const RecordedTouches&);
/// The word of a choice; a name as above, "all" for 0 of what could have one; "" of a number that is told as such.
std::string word_of(const EffectParameter&, double value, const RecordedTouches&);

}  // namespace abbe::diagnose
