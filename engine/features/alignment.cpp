// Conventions, where the standards leave room:
// - Direction of a datum: a plane's normal; the direction of a line, circle, cylinder, cone, torus.
//   A point or a sphere has none, and so has an axis that runs along the primary direction (a bore
//   in the primary plane): as secondary they give the direction from the origin, or from the
//   primary axis, to their own point. A slot, a rectangle or an ellipse in the primary plane gives
//   the direction along it. ROTATE reads a feature in the same way, from the axis that it turns about.
// - Origin of a datum: the coordinate of its point (of a cone the apex) along the new axis, for every
//   shape. For a secondary plane this is where the plane lies when it is associated at a right angle
//   to the primary (ISO 5459:2011): through its centroid, whatever its own small tilt.
#include "engine/features/alignment.hpp"

#include "engine/features/datum_rules.hpp"

namespace abbe {
namespace {

constexpr double kUseless = 1e-3;  // sine below which the projection of a direction would be noise

int index(Axis axis) { return static_cast<int>(axis); }

/// Why a feature gives no direction across an axis, in the words of the statement.
struct NoDirection {
  const char *parallel, *on_axis;
};

constexpr NoDirection kOfSecondary{"the direction of the secondary datum is parallel to the primary",
                                   "the secondary datum lies on the primary axis and gives no direction"};
constexpr NoDirection kOfRotation{"the direction of the feature is parallel to the axis of rotation",
                                  "the feature lies on the axis of rotation and gives no direction"};

/// The unit vector across the axis `primary` that a feature gives, seen from `anchor`, a point of that axis.
Outcome<Vec3> direction_across(Shape shape, const Element& datum, const Vec3& primary, const Vec3& anchor,
                               const NoDirection& failure) {
  const Vec3 own = perpendicular_part(datum.direction, primary);
  const double sine = norm(own);
  const bool straight = shape == Shape::plane || shape == Shape::line;
  if (!is_spot(shape) && sine > (straight ? kUseless : kNearlyParallel)) return {own / sine};
  if (straight) return Outcome<Vec3>::failed(failure.parallel);
  if (is_outline(shape)) return {unit(perpendicular_part(datum.second, primary))};
  const Vec3 there = perpendicular_part(location_of(shape, datum) - anchor, primary);
  const double distance = norm(there);
  if (!(distance > kSameAxis_mm)) return Outcome<Vec3>::failed(failure.on_axis);
  return {there / distance};
}

/// Where the direction to a secondary datum starts: at the first other datum that sets an origin
/// across the primary axis, else on the axis of the primary datum, else at the current origin.
Vec3 anchor_of(const Rigid& X_WD, std::span<const DatumUse> datums, const DatumUse& primary,
               const DatumUse& secondary) {
  const int along = index(primary.direction.axis);
  for (const DatumUse& datum : datums)
    if (&datum != &secondary && datum.shape != Shape::plane &&
        (datum.origin[(along + 1) % 3] || datum.origin[(along + 2) % 3]))
      return location_of(datum.shape, datum.element);
  return primary.shape == Shape::plane ? X_WD.p : location_of(primary.shape, primary.element);
}

/// The axes of a DATSET: the primary alone, or with the first later datum that gives a direction.
Outcome<Mat3> datum_axes(const Rigid& X_WD, std::span<const DatumUse> datums) {
  const DatumUse *primary = nullptr, *secondary = nullptr;
  for (const DatumUse& datum : datums)
    if (datum.gives_direction) {
      if (primary) {
        secondary = &datum;
        break;
      }
      primary = &datum;
    }
  if (!primary) return {X_WD.R};
  if (is_spot(primary->shape)) return Outcome<Mat3>::failed("a point or a sphere gives no direction as primary datum");
  const int first = index(primary->direction.axis);
  const Vec3 u = primary->direction.sign * primary->element.direction;
  if (!secondary) return {keeping_azimuth(X_WD.R, first, u)};
  const int second = index(secondary->direction.axis);
  if (first == second) return Outcome<Mat3>::failed("primary and secondary datum define the same axis");
  const Vec3 anchor = anchor_of(X_WD, datums, *primary, *secondary);
  const Outcome<Vec3> v = direction_across(secondary->shape, secondary->element, u, anchor, kOfSecondary);
  if (!v) return Outcome<Mat3>::failed(v.failure);
  return {from_two_axes(first, u, second, secondary->direction.sign * v.value)};
}

}  // namespace

Outcome<Rigid> datum_frame(const Rigid& X_WD, std::span<const DatumUse> datums) {
  const Outcome<Mat3> axes = datum_axes(X_WD, datums);
  if (!axes) return Outcome<Rigid>::failed(axes.failure);
  Rigid made{axes.value, X_WD.p};
  for (const DatumUse& datum : datums)
    for (int k = 0; k < 3; ++k)
      if (datum.origin[k]) {
        const Vec3 e = column(made.R, k);
        made.p += dot(location_of(datum.shape, datum.element) - made.p, e) * e;
      }
  return {made};
}

Outcome<Rigid> rotated_to(const Rigid& X_WD, Axis axis, Shape shape, const Element& element, AxisDirection toward) {
  const int first = index(axis), second = index(toward.axis);
  if (first == second) return Outcome<Rigid>::failed("an axis cannot be turned toward a feature about itself");
  const Vec3 u = column(X_WD.R, first);
  const Outcome<Vec3> v = direction_across(shape, element, u, X_WD.p, kOfRotation);
  if (!v) return Outcome<Rigid>::failed(v.failure);
  return {{from_two_axes(first, u, second, toward.sign * v.value), X_WD.p}};
}

}  // namespace abbe
