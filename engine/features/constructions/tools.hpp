// What the construction methods share: when directions count as parallel, and how the nominal
// settles the sense of a direction.
#pragma once

#include <span>

#include "engine/features/construct.hpp"
#include "engine/features/shape_traits.hpp"

namespace abbe {

using Shapes = std::span<const Shape>;
using Elements = std::span<const Element>;

inline constexpr double kParallel = 1e-3;  ///< sine below which an intersection would be noise: 0.06 degrees

inline Outcome<Element> cannot(const char* reason) { return Outcome<Element>::failed(reason); }

inline bool parallel(const Vec3& a, const Vec3& b) { return norm(cross(a, b)) < kParallel; }

/// The element with its direction turned to the side of the nominal one; as it is when the nominal
/// direction lies across it.
inline Element in_sense_of(const Element& nominal, Element e) {
  if (dot(e.direction, nominal.direction) < 0) {
    const double begin = e.begin;
    e.direction = -e.direction, e.begin = -e.end, e.end = -begin;
  }
  return e;
}

/// The point of the line through p along the unit vector d that is nearest to q.
constexpr Vec3 foot_on_line(const Vec3& p, const Vec3& d, const Vec3& q) { return p + dot(q - p, d) * d; }
/// The point of the plane through p across the unit vector n that is nearest to q.
constexpr Vec3 foot_on_plane(const Vec3& p, const Vec3& n, const Vec3& q) { return q - dot(q - p, n) * n; }
/// Where the line through p along d meets the plane; d must not lie in the plane.
constexpr Vec3 line_meets_plane(const Vec3& p, const Vec3& d, const Element& plane) {
  return p + dot(plane.point - p, plane.direction) / dot(d, plane.direction) * d;
}

}  // namespace abbe
