// What a diagnosis makes of a name that may be wrong: how far it is believed, and what a machine file gets of it.
#pragma once

#include <algorithm>
#include <cmath>
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
inline bool shown(const std::optional<Improvement>& i) {
  return i && i->log_score_gain > i->se && i->rms_after_um <= i->rms_before_um;
}

/// Whether every size is inside the catalogue's range.
inline bool plausible(const std::vector<DiagnosedParameter>& parameters) {
  return std::all_of(parameters.begin(), parameters.end(), [](const DiagnosedParameter& p) { return p.plausible; });
}
/// Of a size that is not, no machine file may have a setting either.
inline constexpr const char* kNoSuchSize =
    " No such effect has such a size: the name may be wrong, and no machine file carries it.";

inline EffectSetting setting_of(const std::string& effect, const std::vector<DiagnosedParameter>& parameters) {
  EffectSetting setting{effect, {}};
  for (const DiagnosedParameter& p : parameters)
    setting.parameters[p.name] = {p.value, p.word.empty() ? p.u : 0, p.word};
  return setting;
}

/// Sizes that do not go together, made smaller by one factor until they do: less than their uncertainty, or they would not
/// be plausible.
inline EffectSetting without_contradiction(const Effect& effect, EffectSetting setting) {
  constexpr double kStep = 0.99;
  constexpr int kMost = 200;
  const auto contradicts = [&] {
    std::vector<double> theta;
    for (const EffectParameter& p : effect.parameters) {
      const auto found = setting.parameters.find(std::string(p.name));
      theta.push_back(found == setting.parameters.end() || !found->second.word.empty() ? p.standard
                                                                                       : found->second.value);
    }
    return !effect.contradiction(theta.data()).empty();
  };
  for (int k = 0; effect.contradiction && k < kMost && contradicts(); ++k)
    for (const EffectParameter& p : effect.parameters)
      if (const auto found = setting.parameters.find(std::string(p.name));
          p.linear && found != setting.parameters.end())
        found->second.value *= kStep;
  return setting;
}

/// Sizes beside the catalogue's range, but within their uncertainty of it, at its end: a force of -0.01 ±
/// 0.02 N may be none.
inline EffectSetting nearest_possible(const Effect& effect, EffectSetting setting) {
  constexpr double kWithin = 1.96;  // standard uncertainties: the 95 % interval reaches it
  for (const EffectParameter& p : effect.parameters) {
    const auto found = setting.parameters.find(std::string(p.name));
    if (found == setting.parameters.end()) continue;
    found->second.u = std::min(found->second.u, p.high - p.low);
    if (!p.linear) continue;
    const double possible = std::clamp(found->second.value, p.low, p.high);
    if (std::abs(found->second.value - possible) <= kWithin * found->second.u) found->second.value = possible;
  }
  return without_contradiction(effect, std::move(setting));
}

}  // namespace abbe::diagnose
