// Coordinate systems from features (ISO 22093: DATSET, TRANS, ROTATE). Everything here works on one lane; each virtual
// machine builds its own alignment from its own measured features.
#pragma once

#include <span>

#include "engine/base/arguments.hpp"
#include "engine/features/element.hpp"
#include "engine/math/axis.hpp"

namespace abbe {

/// What one datum contributes to a DATSET.
struct DatumUse {
  Shape shape{};
  Element element;  ///< in frame W
  bool gives_direction = false;
  AxisDirection direction;                 ///< which axis its direction defines
  bool origin[3] = {false, false, false};  ///< which coordinates of the origin its point sets to zero
};

/// DATSET: the first datum with a direction fixes that axis (primary), the next the rotation about it
/// (secondary); origins come from the datums that name them, directions and origins not named stay as in
/// `X_WD`, the current frame. Fails when the secondary direction is parallel to the primary.
Outcome<Rigid> datum_frame(const Rigid& X_WD, std::span<const DatumUse> datums);

/// ROTATE/axis,FA(f),dir: turns the current frame about its own `axis` until the direction of the element
/// (frame W), projected into the plane across the axis, points along `toward`; of an outline that lies in that plane it
/// is the one along it. What has no direction there (a point, a sphere, a bore along the axis) comes to lie in that
/// direction from the origin.
Outcome<Rigid> rotated_to(const Rigid& X_WD, Axis axis, Shape shape, const Element& element, AxisDirection toward);

/// The datum reference frame of a tolerance, datums in order of precedence (ISO 5459): primary orients,
/// secondary stops the rotation, each locates what it can. Elements in any one frame; the result is the pose
/// in that frame. Fewer than three datums leave the remaining freedoms as in the identity of that frame.
Outcome<Rigid> datum_reference_frame(std::span<const Shape> shapes, std::span<const Element> datums);

}  // namespace abbe
