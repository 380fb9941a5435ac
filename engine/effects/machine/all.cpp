// The list of the machine's effects.
#include "engine/effects/families.hpp"
#include "engine/effects/machine/machine.hpp"

namespace abbe {

std::span<const Effect* const> machine_effects() {
  static constexpr const Effect* list[] = {
      &kMachineScale, &kMachineSquareness,  &kStraightnessAngleCoupling,
      &kBacklash,     &kScaleInterpolation, &kDynamics,
      &kRamDroop,     &kMapScallops,        &kMachineStep,
  };
  return list;
}

}  // namespace abbe
