// The round surface on which points lie, from the normals there. On every one p = c + R n + t a, with n square to the
// axis a (a ball has none), so that by least squares R = sum (p - p')(n - n') / sum |n - n'|^2, primed: means.
#pragma once

#include <span>

#include "engine/math/vec.hpp"

namespace abbe {

struct RoundFit {
  Vec3 centre;        ///< of a cylinder: of its axis, at the mean height of the points
  double radius = 0;  ///< below zero where the surface is hollow; says nothing where `spread` is close to zero
  double spread = 0;  ///< mean square of the normals about their mean

  /// What the surface leaves of a point with this normal; of a cylinder, its height is left too.
  Vec3 rest(const Vec3& point, const Vec3& normal) const { return point - radius * normal - centre; }
};

/// Of one point at least; one normal by point, of unit length.
inline RoundFit round_fit(std::span<const Vec3> points, std::span<const Vec3> normals) {
  const double share = 1 / static_cast<double>(points.size());
  Vec3 point, normal;
  for (std::size_t i = 0; i < points.size(); ++i) point += share * points[i], normal += share * normals[i];
  RoundFit out;
  double product = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 n = normals[i] - normal;
    product += share * dot(n, points[i] - point), out.spread += share * dot(n, n);
  }
  out.radius = product / out.spread;
  out.centre = point - out.radius * normal;
  return out;
}

}  // namespace abbe
