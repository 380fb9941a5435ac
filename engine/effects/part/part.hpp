// The effects of the workpiece and its fixture (docs/physics/part.md), one per .cpp file.
//
// Here the surface itself is elsewhere than its nominal description says; with `measured = true +
// d`, "true" being that description, d is the displacement of the surface. Effects that are fixed
// to the part are scalars of its own frame.
#pragma once

#include "engine/effects/terms.hpp"

namespace abbe {

extern const Effect kLoadBending;
extern const Effect kClamping;
extern const Effect kPartForm;
extern const Effect kPartShift;

}  // namespace abbe
