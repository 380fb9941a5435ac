#include "engine/diagnose/findings/carried.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/diagnose/findings/known_effect.hpp"
#include "engine/math/normal.hpp"
#include "engine/run/effect_settings.hpp"

namespace abbe::diagnose {

namespace {

constexpr const char* kOfThisPart = " It is of this part: a machine file with it holds for no other part.";
constexpr const char* kNoSuchSize =
    " No such effect has such a size: the name may be wrong, and no machine file carries it.";

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

EffectSetting setting_at(const Effect& effect, const std::vector<double>& theta) {
  EffectSetting s{std::string(effect.name), {}};
  for (std::size_t p = 0; p < theta.size(); ++p) {
    const EffectParameter& parameter = effect.parameters[p];
    EffectSetting::Value& value = s.parameters[std::string(parameter.name)];
    value.value = theta[p];
    if (!parameter.choices.empty()) value.word = parameter.choices[std::lround(theta[p] - parameter.low)];
  }
  return s;
}

EffectSetting setting_from(const Effect& effect, const std::vector<DiagnosedParameter>& figures) {
  EffectSetting setting{std::string(effect.name), {}};
  for (const DiagnosedParameter& p : figures) setting.parameters[p.name] = {p.value, p.word.empty() ? p.u : 0, p.word};
  return setting;
}

bool is_of_one_run(const EffectSetting& setting) {
  return std::any_of(setting.parameters.begin(), setting.parameters.end(),
                     [](const auto& p) { return p.second.word == "one run"; });
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

namespace {

/// A program is simulated from its own start, and so the moment of a later file counts from the start of that.
void count_from_its_file(const Effect& effect, double begun_s, EffectSetting& setting) {
  const std::optional<std::size_t> moment = moment_of(effect);
  if (!moment) return;
  double& at_s = setting.parameters[std::string(effect.parameters[*moment].name)].value;
  at_s = std::max(0.0, at_s - begun_s);
}

/// What happened late in this recording would come late, or never, in a program.
std::string when_in_file(const Effect& effect, const EffectSetting& setting, bool later_file) {
  if (is_of_one_run(setting))
    return " In the machine file it is in that run alone: a simulated program, which has no runs, gets none of it.";
  const double begin_s = begins_at_s(setting);
  const int setup = only_in_setup(setting);
  if (setup > 1)
    return fmt::format(
        " In the machine file it is there in setup {} alone, and a program is run in setup 1: to reckon with it where the part is placed as in setup {}, set its setup to 0 there.",
        setup, setup);
  if (!(begin_s > 0)) return "";
  return fmt::format(" In the machine file it begins {:.0f} s after the start of a program, as {}: {}.", begin_s,
                     later_file ? "in the file in which it came" : "here",
                     effect.stage == Stage::probe ? "for what is measured since it happened, set t0_s to 0 there"
                                                  : "what was set up since it happened has none of it");
}

}  // namespace

std::string carry(const Machine& machine, const Effect& effect, std::vector<DiagnosedParameter>& size, Diagnosis& out,
                  double begun_s) {
  EffectSetting setting = setting_from(effect, size);
  if (begun_s > 0) count_from_its_file(effect, begun_s, setting);
  std::optional<KnownEffect> before = known_effect(machine, effect, setting);
  const auto& taken = out.superseded;
  if (before && std::find(taken.begin(), taken.end(), before->index) != taken.end()) before.reset();
  if (before) setting = before->now;
  setting = nearest_possible(effect, setting);
  const bool gone = before && before->gone;
  const bool possible = gone || plausible(effect, setting);
  for (DiagnosedParameter& p : size) p.plausible = possible;
  if (!possible) return kNoSuchSize;
  if (before) out.superseded.push_back(before->index);
  const std::string when = gone ? "" : when_in_file(effect, setting, begun_s > 0);
  if (!gone) out.model_effects.push_back(std::move(setting));
  const std::string whose = effect.stage == Stage::part ? kOfThisPart : "";
  if (!when.empty()) return whose + when;
  if (!before) return whose;
  return gone           ? " The machine file has the opposite: it is not there any more."
      : before->instead ? " It takes the place of what the machine file has of it."
                        : " That is beside what the machine file has of it.";
}

}  // namespace abbe::diagnose
