// What alignments (alignment.cpp) and datum reference frames (datum_reference_frame.cpp) have in
// common: how near to parallel still means parallel, and what becomes of a rotation that no datum
// fixes.
//
// The thresholds separate what a drawing can mean, not what a machine can resolve: between them and
// any sensible nominal direction lie degrees, so that errors of measurement never take a virtual
// machine to the other side.
#pragma once

#include "engine/features/shape_traits.hpp"

namespace abbe {

inline constexpr double kNearlyParallel = 0.3;  ///< sine, 17 degrees: meant as parallel
inline constexpr double kSameAxis_mm = 0.1;     ///< a point nearer to an axis than this gives no direction from it

constexpr Vec3 column(const Mat3& m, int i) { return i == 0 ? m.cx : i == 1 ? m.cy : m.cz; }

/// The right-handed rotation whose axes `first` and `second` (0..2) are the unit vectors u and v,
/// at right angles.
constexpr Mat3 from_two_axes(int first, const Vec3& u, int second, const Vec3& v) {
  Vec3 axes[3];
  axes[first] = u;
  axes[second] = v;
  const bool cyclic = second == (first + 1) % 3;
  axes[3 - first - second] = cyclic ? cross(u, v) : cross(v, u);
  return {axes[0], axes[1], axes[2]};
}

/// The rotation with axis `first` along the unit vector u that keeps the azimuth of another axis of
/// `old` (its projection across u): of the next one in cyclic order, or of the one after when u
/// lies near that. The rotation of smallest angle would differ in second order only, but turns
/// wildly near a reversal of the axis.
inline Mat3 keeping_azimuth(const Mat3& old, int first, const Vec3& u) {
  int second = (first + 1) % 3;
  if (norm(cross(column(old, second), u)) < kNearlyParallel) second = (first + 2) % 3;
  return from_two_axes(first, u, second, unit(perpendicular_part(column(old, second), u)));
}

}  // namespace abbe
