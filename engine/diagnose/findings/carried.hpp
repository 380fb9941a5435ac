// What a machine file gets of an effect that was found.
#pragma once

#include <string>
#include <vector>

#include "engine/diagnose/diagnosis.hpp"
#include "engine/effects/effect.hpp"
#include "engine/machine/machine.hpp"

namespace abbe::diagnose {

/// Of several names the machine file gets the first, but not one that is believed less than this.
inline constexpr double kCarried = 0.1;
inline constexpr const char* kNotCarried = " It is one of so many that no machine file carries it.";

/// With these values of its parameters; choices as words.
EffectSetting setting_at(const Effect&, const std::vector<double>& theta);
/// With the values as figures say them.
EffectSetting setting_from(const Effect&, const std::vector<DiagnosedParameter>& figures);

/// Whether what a machine file has of it acts in one run of a recording, and so in no simulated program, which has none.
bool is_of_one_run(const EffectSetting&);

/// Sizes beside the catalogue's range, but within their uncertainty of it, at its end: a force of -0.01 ±
/// 0.02 N may be none. Those that do not go together are made smaller by one factor until they do: less than their
/// uncertainty, or they would not be plausible.
EffectSetting nearest_possible(const Effect&, EffectSetting);

/// Puts an effect of this size into `out.model_effects`, beside the other effects of the machine or with what the machine
/// has of it already. Says in each parameter whether that is plausible, and returns what is to be said of it. `begun_s`: how
/// long after the first file that began in which the effect does.
std::string carry(const Machine&, const Effect&, std::vector<DiagnosedParameter>& size, Diagnosis& out,
                  double begun_s = 0);

}  // namespace abbe::diagnose
