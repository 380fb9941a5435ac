// Two ways of using what is known of an effect (GUM 3.2.4 and F.2.4.5).
#pragma once

#include <string_view>

namespace abbe {

enum class EffectUse {
  left_in,    ///< the machine is used as it is: the effect is an error of every result
  corrected,  ///< the estimate is taken out and only the uncertainty of its parameters remains
};

/// As users write it: "left-in", "corrected".
constexpr std::string_view name(EffectUse use) { return use == EffectUse::left_in ? "left-in" : "corrected"; }

}  // namespace abbe
