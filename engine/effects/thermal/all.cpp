// The list of the thermal effects.
#include "engine/effects/families.hpp"
#include "engine/effects/thermal/thermal.hpp"

namespace abbe {

std::span<const Effect* const> thermal_effects() {
  static constexpr const Effect* list[] = {
      &kPartExpansion, &kScaleExpansion, &kTableBending, &kBridgeBending, &kThermalDrift,
      &kThermalCycle,  &kRamGrowth,      &kStylusGrowth, &kPartSoak,
  };
  return list;
}

}  // namespace abbe
