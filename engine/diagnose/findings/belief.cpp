#include "engine/diagnose/findings/belief.hpp"

#include <cmath>

#include "engine/math/normal.hpp"

namespace abbe::diagnose {

namespace {

EffectSetting without_contradiction(const Effect& effect, EffectSetting setting) {
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

}  // namespace

bool shown(const std::optional<Improvement>& i) {
  return i && i->log_score_gain > i->se && i->rms_after_um <= i->rms_before_um;
}

bool plausible(const std::vector<DiagnosedParameter>& parameters) {
  return std::all_of(parameters.begin(), parameters.end(), [](const DiagnosedParameter& p) { return p.plausible; });
}

EffectSetting setting_of(const std::string& effect, const std::vector<DiagnosedParameter>& parameters) {
  EffectSetting setting{effect, {}};
  for (const DiagnosedParameter& p : parameters)
    setting.parameters[p.name] = {p.value, p.word.empty() ? p.u : 0, p.word};
  return setting;
}

EffectSetting nearest_possible(const Effect& effect, EffectSetting setting) {
  for (const EffectParameter& p : effect.parameters) {
    const auto found = setting.parameters.find(std::string(p.name));
    if (found == setting.parameters.end()) continue;
    found->second.u = std::min(found->second.u, p.high - p.low);
    if (!p.linear) continue;
    const double possible = std::clamp(found->second.value, p.low, p.high);
    if (std::abs(found->second.value - possible) <= kNormal95 * found->second.u) found->second.value = possible;
  }
  return without_contradiction(effect, std::move(setting));
}

}  // namespace abbe::diagnose
