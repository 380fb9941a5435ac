// What the number of a parameter stands for, where that has a name.
#pragma once

#include <string>

#include "engine/effects/effect.hpp"
#include "engine/run/recorded/touch.hpp"

namespace abbe::diagnose {

/// The stylus of that number, or the tip in its orientation; "" of any other parameter or number.
std::string called(const EffectParameter&, int number, const RecordedTouches&);

}  // namespace abbe::diagnose
