#include "engine/diagnose/findings/known_effect.hpp"

#include <algorithm>
#include <cmath>

namespace abbe::diagnose {

namespace {

EffectSetting::Value value_of(const EffectSetting& setting, const EffectParameter& p) {
  const auto found = setting.parameters.find(std::string(p.name));
  if (found != setting.parameters.end()) return found->second;
  EffectSetting::Value standard{p.standard, 0, {}};
  if (!p.choices.empty()) standard.word = std::string(p.choices[static_cast<std::size_t>(std::lround(p.standard - p.low))]);
  return standard;
}

/// Whether what is no size is the same, as far as the two are known.
bool same_kind(const Effect& effect, const EffectSetting& a, const EffectSetting& b) {
  constexpr double kRounding = 1e-3, kSame = 3;   // relative; standard uncertainties
  return std::all_of(effect.parameters.begin(), effect.parameters.end(), [&](const EffectParameter& p) {
    if (p.linear) return true;
    const EffectSetting::Value x = value_of(a, p), y = value_of(b, p);
    if (!p.choices.empty()) return x.word == y.word;
    return std::abs(x.value - y.value) <= kSame * std::hypot(x.u, y.u) + kRounding * (std::abs(x.value) + std::abs(y.value));
  });
}

}  // namespace

std::optional<KnownEffect> known_effect(const Machine& machine, const Effect& effect, const EffectSetting& found) {
  if (effect.draws > 0) return std::nullopt;   // sizes of what is drawn anew do not add up
  for (std::size_t k = 0; k < machine.effects.size(); ++k) {
    const EffectSetting& before = machine.effects[k];
    if (before.name != found.name || !same_kind(effect, before, found)) continue;
    KnownEffect out{k, before, true};
    for (const EffectParameter& p : effect.parameters) {
      if (!p.linear) continue;
      const EffectSetting::Value x = value_of(before, p), y = value_of(found, p);
      const EffectSetting::Value sum{x.value + y.value, std::hypot(x.u, y.u), {}};
      if (sum.value != 0 || sum.u != 0) out.now.parameters[std::string(p.name)] = sum;
      out.gone = out.gone && std::abs(sum.value) <= 2 * sum.u;
    }
    return out;
  }
  return std::nullopt;
}

bool plausible(const Effect& effect, const EffectSetting& setting) {
  return std::all_of(effect.parameters.begin(), effect.parameters.end(), [&](const EffectParameter& p) {
    const EffectSetting::Value v = value_of(setting, p);
    return !v.word.empty() || (v.value >= p.low && v.value <= p.high);
  });
}

}  // namespace abbe::diagnose
