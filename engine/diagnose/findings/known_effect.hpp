// An effect that was found although the machine file has it already: in this recording it is larger, smaller,
// or not there any more.
#pragma once

#include <optional>

#include "engine/effects/effect.hpp"
#include "engine/machine/machine.hpp"

namespace abbe::diagnose {

struct KnownEffect {
  std::size_t index = 0;  ///< in the machine's effects
  EffectSetting now;      ///< what the file says and what was found, together
  bool gone = false;      ///< that is nothing, within twice its uncertainties
  bool instead = false;   ///< what was found is all there is: `now` is that
};

/// Nothing where the file does not have this effect of the same stylus, axis, phase, ...
std::optional<KnownEffect> known_effect(const Machine&, const Effect&, const EffectSetting& found);

/// Whether all sizes are in the range of the catalogue.
bool plausible(const Effect&, const EffectSetting&);

}  // namespace abbe::diagnose
