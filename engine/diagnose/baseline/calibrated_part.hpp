// The part of a workpiece file in the baseline of a diagnosis: what is expected of it is taken from the
// residuals, what is uncertain of it is one more random column each, and a surface that is calibrated is no
// longer an unknown. So a sphere of known size tells a tip radius from the size of the sphere, which nothing
// else can.
#pragma once

#include "engine/diagnose/baseline/baseline.hpp"
#include "engine/run/recorded/part.hpp"

namespace abbe::diagnose {

/// Takes the expected residuals from those of the touches.
void remove_expected(const RecordedPart&, RecordedTouches&);
/// Brings the knowledge into the model of the touches; its columns keep their scale.
void calibrate(const RecordedPart&, const RecordedTouches&, Baseline&);

}  // namespace abbe::diagnose
