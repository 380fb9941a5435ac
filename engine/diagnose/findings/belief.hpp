// What a diagnosis makes of a name that may be wrong: how far it is believed, and what a machine file gets of it.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "engine/diagnose/diagnosis.hpp"
#include "engine/effects/effect.hpp"

namespace abbe::diagnose {

/// Below this a name is told as what it looks like, not as what it is.
inline constexpr double kTold = 0.9;
/// The most that is believed of a name that is doubted. A name is doubted
/// - beside something that has none, a pattern or more than chance leaves: whatever made that may have made the rest too;
/// - beside errors of the machine that are twice those of its specification, or more: likewise;
/// - whose size differs between touches more than chance allows (one_size.hpp);
/// - on a covariate that was not logged or did not change: other functions of it would look the same;
/// - where touches are of several styli or orientations that were not logged;
/// - where it is smaller than the steps to which positions are rounded;
/// - of the period of a scale, where touches of the same direction are at the same phase;
/// - of an effect that has no law but a spread: it fits whatever differs so freely;
/// - where it does not predict touches better that it was not fitted to;
/// - with a size outside the catalogue's range: rather the name is wrong than the size;
/// - of scatter, where no touch was repeated or repeats have it in common: it may be a pattern too fine for the recording.
inline constexpr double kDoubted = 0.5;
inline double believed(double probability, bool doubted) {
  return doubted ? std::min(probability, kDoubted) : probability;
}

/// Of several names the machine file gets the first, but not one that is believed less than this.
inline constexpr double kCarried = 0.1;

/// Whether held-out touches are predicted better by more than the standard error of the gain, and lie closer. A score may
/// gain because a model is less sure of itself.
bool shown(const std::optional<Improvement>&);

/// Whether every size is inside the catalogue's range.
bool plausible(const std::vector<DiagnosedParameter>&);
/// Of a size that is not, no machine file may have a setting either.
inline constexpr const char* kNoSuchSize =
    " No such effect has such a size: the name may be wrong, and no machine file carries it.";

EffectSetting setting_of(const std::string& effect, const std::vector<DiagnosedParameter>&);

/// Sizes beside the catalogue's range, but within their uncertainty of it, at its end: a force of -0.01 ±
/// 0.02 N may be none. Those that do not go together are made smaller by one factor until they do: less than their
/// uncertainty, or they would not be plausible.
EffectSetting nearest_possible(const Effect&, EffectSetting);

}  // namespace abbe::diagnose
