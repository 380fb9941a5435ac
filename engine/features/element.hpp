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

/// Whether a feature is made of faces. All others are curved, or points of a surface of which no more is known.
constexpr bool is_flat(Shape s) {
  return s == Shape::line || s == Shape::plane || s == Shape::slot || s == Shape::rectangle ||
      s == Shape::parallel_planes || s == Shape::symmetry_plane;
}

/// A geometric element, in whatever frame its holder says (mm; directions are unit vectors).
///
/// | shape    | point                     | direction               | size            | angle      |
/// |----------|---------------------------|-------------------------|-----------------|------------|
/// | point    | the point                 | surface normal          |                 |            |
/// | line     | a point of it (centroid)  | along                   |                 |            |
/// | plane    | a point of it (centroid)  | normal, out of material |                 |            |
/// | circle   | centre                    | normal of its plane     | radius          |            |
/// | cylinder | point of the axis         | axis                    | radius          |            |
/// | sphere   | centre                    | (unused)                | radius          |            |
/// | cone     | point of the axis         | apex to open side       | radius at point | half angle |
/// | torus    | centre                    | axis                    | major radius    |            |
/// | arc      | as a circle; `second` from the centre to its start; `angle` how far it sweeps      |
/// | edge_point | the point               | the edge's vector       | `second`: normal of the surface beside it |
/// | surface  | mean of the touches       | (unused)                |                 |            |
/// | slot     | centre                    | normal of its plane     | half length     | `minor_size`: half width |
/// | rectangle | centre                   | third side              | half of first side | `minor_size`: half
/// of the second | | ellipse  | centre                    | normal of its plane     | major half axis |
/// `minor_size`: minor half axis | | parallel_planes, symmetry_plane | middle of the median plane | its
/// normal | half width | |
struct Element {
  Vec3 point;
  Vec3 direction{0, 0, 1};
  double size = 0;        ///< mm
  double minor_size = 0;  ///< torus: radius of the tube, mm
  /// What turns the element about `direction`, a unit vector: along a slot, the first side of a rectangle,
  /// the major axis of an ellipse; of a line the normal of its surface. Unused by others.
  Vec3 second{1, 0, 0};
  double angle = 0;  ///< cone: half angle, rad
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
