#include "engine/run/effect_settings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "engine/base/diagnostic.hpp"
#include "engine/base/numbers.hpp"

namespace abbe {

namespace {

std::string did_you_mean(std::string_view name, const std::vector<std::string_view>& candidates,
                         std::string otherwise) {
  const std::string near = nearest_name(name, candidates);
  return near.empty() ? otherwise : "did you mean '" + near + "'?";
}

/// An ordinal that may stand for none in particular: the stylus in every orientation, every setup.
bool may_be_all(const EffectParameter& p) { return p.is_code() && p.choices.empty() && p.low == 0; }

/// A setting that cannot be used, said where it stands.
class Refusal {
 public:
  Refusal(const EffectSetting& setting, const std::string& machine)
      : setting_(setting), whose_(setting.option.empty() ? fmt::format("machine '{}'", machine) : setting.option) {}

  [[noreturn]] void unknown_effect() const {
    std::vector<std::string_view> names;
    for (const Effect* e : effects()) names.push_back(e->name);
    refuse(setting_.span, Code::E0305, "unknown effect",
           did_you_mean(setting_.name, names, "`abbe explain` lists them"));
  }
  [[noreturn]] void unknown_parameter(const Effect& effect, const std::string& name, Span span) const {
    std::vector<std::string_view> names;
    for (const EffectParameter& p : effect.parameters) names.push_back(p.name);
    refuse(span, Code::E0306, fmt::format("it has no parameter '{}'", name),
           did_you_mean(name, names, fmt::format("it has: {}", fmt::join(names, ", "))));
  }
  [[noreturn]] void impossible(const EffectParameter& p, const std::string& value, Span span) const {
    const std::string unit = p.unit == "1" ? "" : fmt::format(" {}", p.unit);
    const std::string help = !p.choices.empty() ? fmt::format("give one of: {}", fmt::join(p.choices, ", "))
        : may_be_all(p) ? fmt::format("give {}, or a whole number from {:g} to {:g}", kAll, p.low, p.high)
        : p.is_code()   ? fmt::format("give a whole number from {:g} to {:g}", p.low, p.high)
                        : fmt::format("give a number from {:g} to {:g}{}", p.low, p.high, unit);
    refuse(span, Code::E0307,
           fmt::format("{}={} is not {}", p.name, value, p.is_code() ? "a value that it can have" : "plausible"), help);
  }
  [[noreturn]] void not_read(const EffectParameter& p, std::string_view at, Span span) const {
    const auto& [choice, word, not_at] = p.only_with;
    refuse(span, Code::E0307, fmt::format("{} says nothing with {}={}", p.name, choice, at),
           fmt::format("{} {}={}, or leave {} out", not_at ? "give another than" : "add", choice, word, p.name));
  }
  [[noreturn]] void contradiction(std::string_view what) const {
    refuse(setting_.span, Code::E0307, std::string(what),
           fmt::format("`abbe explain {}` says what its parameters mean", setting_.name));
  }
  [[noreturn]] void quoted_number(const EffectParameter& p, const std::string& word, Span span) const {
    refuse(span, Code::E0405, fmt::format("{} is the text \"{}\", but must be a number", p.name, word),
           fmt::format("leave out the quotes: \"{}\": {}", p.name, word));
  }
  [[noreturn]] void uncertain_choice(const EffectParameter& p, Span span) const {
    refuse(span, Code::E0307, fmt::format("{} is a choice and has no uncertainty", p.name), "leave \"u\" out");
  }

 private:
  [[noreturn]] void refuse(Span span, Code code, const std::string& what, const std::string& help) const {
    const std::string message = fmt::format("effect '{}' of {}: {}", setting_.name, whose_, what);
    throw UserError(setting_.file ? diagnostic_at(*setting_.file, span, code, message, help)
                                  : diagnostic(code, message, help));
  }

  const EffectSetting& setting_;
  std::string whose_;
};

std::optional<std::size_t> parameter_index(const Effect& effect, const std::string& name) {
  for (std::size_t p = 0; p < effect.parameters.size(); ++p)
    if (effect.parameters[p].name == name) return p;
  return std::nullopt;
}

/// The number of a parameter, which may be given as the word of a choice ("axis": "x").
double checked_value(const EffectParameter& p, const EffectSetting::Value& given, const Refusal& refusal) {
  double value = given.value;
  if (!given.word.empty()) {
    if (may_be_all(p) && given.word == kAll) return 0;
    const auto found = std::find(p.choices.begin(), p.choices.end(), given.word);
    if (p.choices.empty() && finite_number(given.word)) refusal.quoted_number(p, given.word, given.span);
    if (found == p.choices.end()) refusal.impossible(p, given.word, given.span);
    value = p.low + static_cast<double>(found - p.choices.begin());
  }
  if (value < p.low || value > p.high || (p.is_code() && value != std::floor(value)))
    refusal.impossible(p, fmt::format("{:g}", value), given.span);
  if (p.is_code() && given.u != 0) refusal.uncertain_choice(p, given.span);
  if (given.u > p.high - p.low)
    refusal.impossible(p, fmt::format("{:g} with a standard uncertainty of {:g}", value, given.u), given.span);
  return value;
}

/// A person who gives on the command line what no one reads means something else. (A machine file may carry it.)
void check_that_all_count(const Effect& effect, const EffectSetting& setting, const std::vector<double>& value,
                          const Refusal& refusal) {
  if (setting.option.empty()) return;
  for (std::size_t k = 0; k < value.size(); ++k) {
    const EffectParameter& p = effect.parameters[k];
    const auto given = setting.parameters.find(std::string(p.name));
    if (p.only_with.choice.empty() || given == setting.parameters.end() || value[k] == p.standard) continue;
    const std::size_t choice = *parameter_index(effect, std::string(p.only_with.choice));
    const EffectParameter& chosen = effect.parameters[choice];
    const std::string_view at = chosen.choices[static_cast<std::size_t>(value[choice] - chosen.low)];
    if ((at == p.only_with.word) == p.only_with.not_at) refusal.not_read(p, at, given->second.span);
  }
}

}  // namespace

ResolvedEffect resolve(const EffectSetting& setting, const std::string& machine) {
  const Refusal refusal(setting, machine);
  const Effect* const found = find_effect(setting.name);
  if (!found) refusal.unknown_effect();
  const Effect& effect = *found;
  ResolvedEffect out{found, {}, std::vector<double>(effect.parameters.size(), 0.0)};
  for (const EffectParameter& p : effect.parameters) out.value.push_back(p.standard);
  for (const auto& [name, value] : setting.parameters) {
    const std::optional<std::size_t> p = parameter_index(effect, name);
    if (!p) refusal.unknown_parameter(effect, name, value.span);
    out.value[*p] = checked_value(effect.parameters[*p], value, refusal);
    out.u[*p] = value.u;
  }
  check_that_all_count(effect, setting, out.value, refusal);
  const std::string_view wrong = effect.contradiction ? effect.contradiction(out.value.data()) : "";
  if (!wrong.empty()) refusal.contradiction(wrong);
  return out;
}

double begins_at_s(const EffectSetting& setting) {
  const Effect& effect = *find_effect(setting.name);
  const std::optional<std::size_t> moment = moment_of(effect);
  if (!moment) return 0;
  const auto given = setting.parameters.find(std::string(effect.parameters[*moment].name));
  return given == setting.parameters.end() ? effect.parameters[*moment].standard : given->second.value;
}

int only_in_setup(const EffectSetting& setting) {
  for (const EffectParameter& p : find_effect(setting.name)->parameters) {
    if (p.sought != Sought::setup) continue;
    const auto given = setting.parameters.find(std::string(p.name));
    if (given != setting.parameters.end()) return static_cast<int>(given->second.value);
  }
  return 0;
}

const EffectParameter* missing_size(const EffectSetting& setting) {
  const std::span<const EffectParameter> parameters = find_effect(setting.name)->parameters;
  const EffectParameter* first = nullptr;
  for (const EffectParameter& p : parameters) {
    if (p.standard != 0 || !(p.linear || &p == &parameters.front())) continue;
    const auto given = setting.parameters.find(std::string(p.name));
    if (given != setting.parameters.end() && (given->second.value != 0 || given->second.u != 0)) return nullptr;
    if (!first) first = &p;
  }
  return first;
}

}  // namespace abbe
