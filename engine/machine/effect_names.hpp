// What tells the settings of a machine file apart where an effect stands there several times, of other axes or styli.
#pragma once

#include <string>
#include <vector>

#include "engine/machine/machine.hpp"

namespace abbe {

/// Names of the settings in reports, and of their random numbers: that of the effect, from its second setting
/// on with a number ("machine.scale #2").
std::vector<std::string> effect_names(const std::vector<EffectSetting>&);

}  // namespace abbe
