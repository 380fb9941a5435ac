// What a feature *is* once measured, constructed or nominal: one struct for all kinds, so that constructions,
// alignments and tolerances need no case per pair of kinds.
#pragma once

#include "engine/math/vec.hpp"

namespace abbe {

/// The geometric elements of ISO 22093 that Abbe knows. Each is described by its FeatureKind (feature.hpp).
enum class Shape {
  point,
  line,
  plane,
  circle,
  cylinder,
  sphere,
  cone,
  torus,
  arc,
  edge_point,
  surface,
  slot,
  rectangle,
  ellipse,
  parallel_planes,
  symmetry_plane
};

/// A geometric element, in whatever frame its holder says (mm; directions are unit vectors).
///
/// - point: the point; direction the surface normal.
/// - line: a point of it (centroid); along it.
/// - plane: a point of it (centroid); its normal, out of the material.
/// - circle: its centre; normal of its plane; size its radius.
/// - cylinder: a point of the axis; the axis; size its radius.
/// - sphere: its centre; direction of a nominal one towards its pole, else unused; size its radius.
/// - cone: a point of the axis; from the apex to the open side; size the radius at that point, angle its half angle.
/// - torus: its centre; its axis; size the major radius, minor_size that of the tube.
/// - arc: as a circle; second points from the centre to its start, angle is how far it sweeps.
/// - edge_point: the point; the edge's vector; second the normal of the surface beside it.
/// - surface: the mean of the touches; direction unused.
/// - slot: its centre; normal of its plane; size half its length, minor_size half its width; second along it; angle
///   1 where its ends are flat, 0 where they are round.
/// - rectangle: its centre; the third side; size half the first side, minor_size half the second; second the first.
/// - ellipse: its centre; normal of its plane; size the major half axis, minor_size the minor one; second the major.
/// - parallel_planes, symmetry_plane: the middle of the median plane; its normal; size half the width.
struct Element {
  Vec3 point;
  Vec3 direction{0, 0, 1};
  double size = 0;        ///< mm
  double minor_size = 0;  ///< mm
  /// What turns the element about `direction`, a unit vector: along a slot, the first side of a rectangle,
  /// the major axis of an ellipse; of a line the normal of its surface. Unused by others.
  Vec3 second{1, 0, 0};
  double angle = 0;  ///< rad, or a choice
  /// Signed residuals of the fit, out of the material positive: form = high - low. For a 3-D line low =
  /// -high, where high is the largest distance, so that form is the diameter of the enclosing cylinder (of a
  /// line of a surface it is less: engine/tolerances/form.hpp). Zero for what was not fitted.
  double low = 0, high = 0;
  /// Where along `direction` the data lie, as signed distances from `point`: the ends of a line or of an
  /// axis. For a plane -begin = end is the largest distance of the data from `point`, within the plane. Zero
  /// where no data say.
  double begin = 0, end = 0;
};

/// The same element in another frame: `X_AB` takes frame B, in which it is given, to A.
constexpr Element operator*(const Rigid& X_AB, const Element& in_B) {
  Element in_A = in_B;
  in_A.point = X_AB * in_B.point;
  in_A.direction = X_AB.R * in_B.direction;
  in_A.second = X_AB.R * in_B.second;
  return in_A;
}

}  // namespace abbe
