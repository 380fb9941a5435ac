// The list of the probe's effects.
#include "engine/effects/families.hpp"
#include "engine/effects/probe/probe.hpp"

namespace abbe {

std::span<const Effect* const> probe_effects() {
  static constexpr const Effect* list[] = {
      &kPretravelLobing, &kStylusBending, &kTipRadius,    &kTipForm,   &kContactFlattening,
      &kTriggerDelay,    &kCosineError,   &kStylusLength, &kProbeStep,
  };
  return list;
}

}  // namespace abbe
