// The datum reference frame of a tolerance (ISO 5459:2011): datums take freedoms away one after
// another.
//
// z is the direction of the first datum that has one; x the first direction across z, a datum's own
// or the direction from the located origin to it. A plane fixes the origin along its normal, an
// axis across itself, a point, a sphere or the centre of a torus in all directions; a cone is an
// axis and its apex. A slot, a rectangle or an ellipse has two directions, its normal and the one along
// it: in the plane of the primary it stops the rotation, after a bore that it points to by where it is.
// What an earlier datum has fixed stays fixed, and a datum that adds nothing has no effect.
//
// The fitted datums have no orientation constraint, so each is used at its own point: a secondary
// plane at a right angle to the primary passes through its centroid, whatever its own small tilt. A
// plane at a slant to the earlier datums acts along its own normal.
#include <cmath>

#include "engine/base/ids.hpp"
#include "engine/features/alignment.hpp"
#include "engine/features/datum_rules.hpp"
#include "engine/features/shape_traits.hpp"

namespace abbe {
namespace {

constexpr double kNearlySquare = 0.95;  // cosine of 17 degrees: meant as a right angle

/// Axes and origin as far as the datums so far fix them.
class Frame {
 public:
  void add(Shape shape, const Element& datum) {
    orient(shape, datum);
    locate(shape, datum);
  }

  Rigid pose() const {
    if (axes_ == 0) return {{}, origin_};
    if (axes_ == 1) return {keeping_azimuth({}, 2, z_), origin_};
    return {from_two_axes(2, z_, 0, x_), origin_};
  }

 private:
  void orient(Shape shape, const Element& datum) {
    if (!is_spot(shape)) take_direction(datum.direction);
    if (is_outline(shape) && !points_to_origin(datum)) take_direction(datum.second);
    if (shape == Shape::plane || axes_ == 2) return;
    if (axes_ == 0 ? fixed_ == 3 : located_across()) {
      const Vec3 there = datum.point - origin_;
      const Vec3 across = axes_ == 0 ? there : perpendicular_part(there, z_);
      if (norm(across) > kSameAxis_mm) take_direction(unit(across));
    }
  }

  /// Whether the sides of an outline lie along the arm from the located origin: how far they turn about it then shows in
  /// where they are, much more than in their own direction.
  bool points_to_origin(const Element& outline) const {
    if (!located_across()) return false;
    const Vec3 arm = perpendicular_part(outline.point - origin_, z_);
    const double along = std::fabs(dot(arm, outline.second));
    return along > outline.size && along > norm(arm - dot(arm, outline.second) * outline.second);
  }

  void take_direction(const Vec3& d) {
    if (axes_ == 0) {
      z_ = d;
      axes_ = 1;
    } else if (axes_ == 1) {
      const Vec3 across = perpendicular_part(d, z_);
      const double sine = norm(across);
      if (sine < kNearlyParallel) return;
      x_ = across / sine;
      axes_ = 2;
    }
  }

  void locate(Shape shape, const Element& datum) {
    if (is_spot(shape) || shape == Shape::torus) {
      for (int k = 0; k < 3; ++k)
        if (const Vec3 row = free_part(column({}, k)); norm(row) > kNearlyParallel) fix(unit(row), datum.point);
    } else if (shape == Shape::plane) {
      locate_across(datum.direction, datum.point);
    } else {
      const Vec3 u = across(datum.direction);
      locate_across(u, datum.point);
      locate_across(cross(datum.direction, u), datum.point);
      if (shape == Shape::cone) locate_across(datum.direction, apex(datum));
    }
  }

  /// The origin shall lie in the plane through q across the unit vector n, as far as the rows
  /// before leave that free.
  void locate_across(const Vec3& n, const Vec3& q) {
    const Vec3 rest = free_part(n);
    const double share = norm(rest);
    if (share < kNearlyParallel) return;
    const Vec3 row = rest / share;
    if (share > kNearlySquare) return fix(row, q);
    fix(row, origin_ + dot(n, q - origin_) / share * row);
  }

  /// The coordinate of the origin along the unit vector `row`, at a right angle to the rows before,
  /// becomes that of q.
  void fix(const Vec3& row, const Vec3& q) {
    origin_ += dot(row, q - origin_) * row;
    rows_[fixed_++] = row;
  }

  Vec3 free_part(Vec3 v) const {
    if (fixed_ == 3) return {};
    for (int i = 0; i < fixed_; ++i) v = perpendicular_part(v, rows_[i]);
    return v;
  }

  /// A unit vector across the axis d: across z too, or along x for an axis along z.
  Vec3 across(const Vec3& d) const {
    const Vec3 u = cross(z_, d);
    if (norm(u) > kNearlyParallel) return unit(u);
    return axes_ == 2 ? unit(perpendicular_part(x_, d)) : any_perpendicular(d);
  }

  bool located_across() const {
    double inside = 0;  // squared length of the part of the fixed directions across z
    for (int i = 0; i < fixed_; ++i) inside += dot(perpendicular_part(rows_[i], z_), perpendicular_part(rows_[i], z_));
    return inside > 2 - kNearlyParallel;
  }

  Vec3 x_, z_, origin_, rows_[3];
  int axes_ = 0, fixed_ = 0;
};

}  // namespace

Outcome<Rigid> datum_reference_frame(std::span<const Shape> shapes, std::span<const Element> datums) {
  ABBE_CHECK(shapes.size() == datums.size());
  if (datums.size() > 3) return Outcome<Rigid>::failed("a datum reference frame has at most three datums");
  Frame frame;
  for (std::size_t i = 0; i < datums.size(); ++i) frame.add(shapes[i], datums[i]);
  return {frame.pose()};
}

}  // namespace abbe
