// The effects of the probe and its stylus (docs/physics/probe.md), one per .cpp file.
#pragma once

#include "engine/effects/effect.hpp"

namespace abbe {

extern const Effect kPretravelLobing;
extern const Effect kStylusBending;
extern const Effect kTipRadius;
extern const Effect kTipForm;
extern const Effect kContactFlattening;
extern const Effect kTriggerDelay;
extern const Effect kCosineError;
extern const Effect kStylusLength;
extern const Effect kProbeStep;

}  // namespace abbe
