#include "engine/diagnose/findings/known_effect.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "engine/effects/direction.hpp"

namespace abbe::diagnose {

namespace {

/// As the file gives it, or the standard; a choice as its word, also where the file has its code.
EffectSetting::Value value_of(const EffectSetting& setting, const EffectParameter& p) {
  const auto found = setting.parameters.find(std::string(p.name));
  EffectSetting::Value value =
      found != setting.parameters.end() ? found->second : EffectSetting::Value{p.standard, 0, {}};
  const auto choice = static_cast<std::size_t>(std::lround(value.value - p.low));
  if (value.word.empty() && choice < p.choices.size()) value.word = std::string(p.choices[choice]);
  return value;
}

/// Index of the parameter `direction`, which azimuth and elevation follow; nothing for an effect whose size
/// is no vector.
std::optional<std::size_t> effect_direction(const Effect& effect) {
  const auto found = std::find_if(effect.parameters.begin(), effect.parameters.end(),
                                  [](const EffectParameter& p) { return is_direction(p); });
  return found == effect.parameters.end() ? std::nullopt
                                          : std::optional(static_cast<std::size_t>(found - effect.parameters.begin()));
}
bool of_direction(const EffectParameter& p) {
  return is_direction(p) || p.name == kAzimuthParameter.name || p.name == kElevationParameter.name;
}

/// Whether what is no size is the same, as far as the two are known.
bool same_kind(const Effect& effect, const EffectSetting& a, const EffectSetting& b) {
  constexpr double kRounding = 1e-3, kSame = 3;  // relative; standard uncertainties
  return std::all_of(effect.parameters.begin(), effect.parameters.end(), [&](const EffectParameter& p) {
    if (p.linear || (effect_direction(effect) && of_direction(p))) return true;
    const EffectSetting::Value x = value_of(a, p), y = value_of(b, p);
    if (!p.choices.empty()) return x.word == y.word;
    return std::abs(x.value - y.value) <=
        kSame * std::hypot(x.u, y.u) + kRounding * (std::abs(x.value) + std::abs(y.value));
  });
}

/// Rounding and outliers are read off the recording as they are; all other scatter is found beside what the
/// machine file has of it.
bool judged_whole(const Effect& effect) { return effect.draws > 0 && !effect.linear_in_draws; }

EffectSetting::Value sum_of(const EffectSetting::Value& x, const EffectSetting::Value& y) {
  return {x.value + y.value, std::hypot(x.u, y.u), {}};
}

/// Of standard deviations: the variances of what draws its own numbers add.
EffectSetting::Value sum_of_variances(const EffectSetting::Value& x, const EffectSetting::Value& y) {
  const double sd = std::hypot(x.value, y.value);
  return {sd, sd > 0 ? std::hypot(x.value * x.u, y.value * y.u) / sd : std::hypot(x.u, y.u), {}};
}

/// The vector that the size of an effect with a direction is, and the standard uncertainty of its components,
/// all together.
struct SizedVector {
  Vec3 size;
  double u = 0;
};
SizedVector vector_of(const EffectSetting& s, const Effect& effect, std::size_t direction) {
  const auto parameters = effect.parameters;
  const auto size =
      std::find_if(parameters.begin(), parameters.end(), [](const EffectParameter& p) { return p.linear; });
  const EffectSetting::Value amplitude = value_of(s, *size), azimuth = value_of(s, parameters[direction + 1]),
                             elevation = value_of(s, parameters[direction + 2]);
  const auto word =
      std::find(std::begin(kDirectionChoices), std::end(kDirectionChoices), value_of(s, parameters[direction]).word);
  const double theta[] = {double(word - std::begin(kDirectionChoices)), azimuth.value, elevation.value};
  return {amplitude.value * chosen_direction(theta),
          std::hypot(amplitude.u, amplitude.value * kDegree * std::hypot(azimuth.u, elevation.u))};
}

/// The sum of two vectors: what was mended has its opposite.
KnownEffect added(std::size_t index, const Effect& effect, std::size_t direction, const EffectSetting& before,
                  const EffectSetting& found) {
  const SizedVector x = vector_of(before, effect, direction), y = vector_of(found, effect, direction);
  const Vec3 sum = x.size + y.size;
  const double size = norm(sum), flat = std::hypot(sum.x, sum.y), u = std::hypot(x.u, y.u);
  KnownEffect out{index, before, size <= 2 * u, false};
  const auto set = [&](const EffectParameter& p, const EffectSetting::Value& value) {
    out.now.parameters[std::string(p.name)] = value;
  };
  for (const EffectParameter& p : effect.parameters)
    if (p.linear) set(p, {size, u, {}});
  set(effect.parameters[direction], {0, 0, std::string(kDirectionChoices[3])});
  set(effect.parameters[direction + 1],
      {in_degrees(std::atan2(sum.y, sum.x)), std::min(180.0, in_degrees(u / std::max(flat, u))), {}});
  set(effect.parameters[direction + 2],
      {in_degrees(std::atan2(sum.z, flat)), std::min(90.0, in_degrees(u / std::max(size, u))), {}});
  return out;
}

/// What scatters more than before is not gone.
KnownEffect together(std::size_t index, const Effect& effect, const EffectSetting& before, const EffectSetting& found) {
  const bool drawn = effect.draws > 0;
  KnownEffect out{index, before, !drawn, false};
  for (const EffectParameter& p : effect.parameters) {
    if (!p.linear) continue;
    const auto sum = (drawn ? sum_of_variances : sum_of)(value_of(before, p), value_of(found, p));
    if (sum.value != 0 || sum.u != 0) out.now.parameters[std::string(p.name)] = sum;
    out.gone = out.gone && std::abs(sum.value) <= 2 * sum.u;
  }
  return out;
}

}  // namespace

std::optional<KnownEffect> known_effect(const Machine& machine, const Effect& effect, const EffectSetting& found) {
  for (std::size_t k = 0; k < machine.effects.size(); ++k) {
    const EffectSetting& before = machine.effects[k];
    if (before.name != found.name) continue;
    if (judged_whole(effect)) return KnownEffect{k, found, false, true};
    if (!same_kind(effect, before, found)) continue;
    const std::optional<std::size_t> direction = effect_direction(effect);
    return direction ? added(k, effect, *direction, before, found) : together(k, effect, before, found);
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
