#include "engine/diagnose/explanations/value_called.hpp"

#include <fmt/format.h>

#include "engine/run/effect_settings.hpp"

namespace abbe::diagnose {

std::string called(const EffectParameter& parameter, int number, const RecordedTouches& touches) {
  const bool tip = parameter.sought == Sought::tip;
  if (!tip && parameter.sought != Sought::stylus) return "";
  for (const RecordedTouch& touch : touches.touches) {
    const StylusScene& s = touch.scene.stylus;
    if (tip && s.tip_ordinal == number)
      return fmt::format("{} at A {:.1f} B {:.1f}", s.name, in_degrees(s.head_a_rad), in_degrees(s.head_b_rad));
    if (!tip && s.ordinal == number) return touches.styli[number - 1];
  }
  return "";
}

std::string word_of(const EffectParameter& parameter, double value, const RecordedTouches& touches) {
  if (!parameter.choices.empty())
    return std::string(parameter.choices[static_cast<std::size_t>(value - parameter.low + 0.5)]);
  if (value == 0 && parameter.is_code()) return std::string(kAll);
  if (value == 0 && parameter.sought == Sought::speed) return "none";
  return called(parameter, static_cast<int>(value), touches);
}

bool counts(const Effect& effect, const EffectParameter& parameter, const std::vector<double>& theta) {
  const auto& [name, word, not_at] = parameter.only_with;
  for (std::size_t p = 0; p < effect.parameters.size(); ++p)
    if (const EffectParameter& choice = effect.parameters[p]; choice.name == name)
      return (word_of(choice, theta[p], {}) == word) != not_at;
  return true;
}

}  // namespace abbe::diagnose
