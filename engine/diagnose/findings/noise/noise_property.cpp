#include "engine/diagnose/findings/noise/noise_property.hpp"

#include <algorithm>

#include "engine/math/normal.hpp"

namespace abbe::diagnose {

std::span<const NoiseProperty* const> noise_properties() {
  static constexpr const NoiseProperty* kAll[] = {&kJudgedResolution, &kJudgedOutliers, &kJudgedUnequal,
                                                  &kJudgedVibration};
  return kAll;
}

DiagnosedParameter figure(const char* name, const char* unit, double value, double u) {
  const double low = value - kNormal95 * u, high = value + kNormal95 * u;
  return {.name = name,
          .unit = unit,
          .value = value,
          .u = u,
          .low = value < 0 ? low : std::max(0.0, low),
          .high = value < 0 ? std::min(0.0, high) : high};
}

std::optional<EffectSetting::Value> in_machine_file(const Case& c, const Effect& effect, const std::string& parameter) {
  for (const EffectSetting& s : c.machine->effects)
    if (const auto found = s.parameters.find(parameter); s.name == effect.name && found != s.parameters.end())
      return found->second;
  return std::nullopt;
}

Repeats repeats_of(const Case& c, const Residuals& r, const Vector& in, double share) {
  const auto pairs = repeats_in(c, in);
  double common = 0, squares = 0;
  for (const auto& [first, again] : pairs) {
    const double a = r.standardised(first), b = r.standardised(again);
    common += a * b, squares += (a * a + b * b) / 2;
  }
  return pairs.size() < kEnoughRepeats       ? Repeats::too_few
      : common < kInCommon * share * squares ? Repeats::differ
                                             : Repeats::agree;
}

void ask_repeats(const Scatter& s, const Vector& in, double share, NoiseFinding& f) {
  f.repeats = repeats_of(s.c, s.residuals, in, share);
  f.certain = f.repeats == Repeats::differ;
}

}  // namespace abbe::diagnose
