// The effects of the machine's structure and scales (docs/physics/machine.md), one per .cpp file.
#pragma once

#include "engine/effects/effect.hpp"

namespace abbe {

extern const Effect kMachineScale;
extern const Effect kMachineSquareness;
extern const Effect kStraightnessAngleCoupling;
extern const Effect kBacklash;
extern const Effect kScaleInterpolation;
extern const Effect kDynamics;
extern const Effect kRamDroop;
extern const Effect kMapScallops;
extern const Effect kMachineStep;

}  // namespace abbe
