// How far a measured feature lies from its nominal, as a displacement of the place that the nominal
// names: what a measurement relative to that feature (RMEAS) moves its touches by.
//
// Only what the feature determines counts. A plane says nothing about shifts within itself and a
// line or axis nothing about shifts along itself, although their points of reference move with
// every change of the touches.
#pragma once

#include "engine/features/element.hpp"

namespace abbe {

/// Displacement in mm, in the frame of both elements: of planes along the nominal normal, of lines
/// and axes across the nominal direction, of all others the difference of their points. A plane
/// square to its nominal or an axis across it has no such displacement and gives zero.
Vec3 displacement(Shape, const Element& actual, const Element& nominal);

}  // namespace abbe
