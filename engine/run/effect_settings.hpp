// What a machine file or the command line says of an effect, resolved against the registry.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/effects/effect.hpp"
#include "engine/machine/machine.hpp"

namespace abbe {

/// The word for 0 of an ordinal that may stand for none in particular.
inline constexpr std::string_view kAll = "all";

struct ResolvedEffect {
  const Effect* effect = nullptr;
  std::vector<double> value, u;  ///< by parameter, in its unit: best estimate and standard uncertainty
};

/// Throws UserError, with the place of the setting: unknown effect or parameter (with the nearest known name), value
/// outside its plausible range, a choice that is none. `machine` names the machine in messages.
ResolvedEffect resolve(const EffectSetting&, const std::string& machine);

/// The size that a setting of a known effect does not give, so that it does nothing; nullptr: it has one.
const EffectParameter* missing_size(const EffectSetting&);

/// When in a program the effect begins, s; 0 of one that is there from the start.
double begins_at_s(const EffectSetting&);

/// The only placement of the part in which the effect is there; 0 of one that is there in every placement. A program is
/// run in the first.
int only_in_setup(const EffectSetting&);

}  // namespace abbe
