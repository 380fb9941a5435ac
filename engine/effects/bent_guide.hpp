// A guideway that is bent in its vertical plane. The carriage on it does two things at once: it
// follows the height of the guide and it pitches with its slope, and the pitch acts on the Abbe arm
// from the carriage to the tip. So a bent guide is never a straightness error alone.
//
// A guide along axis i (x or y) with the curvature k > 0 of an arch (its middle is high) lowers the
// carriage at reading s by k s^2 / 2 and pitches it by k s. With `measured = true + d` and the
// lever l from the carriage's frame to the tip this is
//
//   d_z = + k s^2 / 2 + k s l_i        d_i = - k s l_z
//
// A carriage that carries the part stands at -s on its guide when the scale reads s, and what it
// does the surface does: d_z = - k s^2 / 2 + k s l_i, with the lever to the point on the part, and
// the same d_i.
//
// Height and slope count from the scale's zero, as in the error functions of the geometric model.
// Another origin changes d only by a rigid motion (and the scale of axis i if also l_z were counted
// from elsewhere), which an alignment takes out.
// Source: small rotations of a rigid body; Timoshenko, J. Opt. Soc. Am. 11 (1925) 233 for k = cte
// dT / h of a heated plate.
#pragma once

#include "engine/effects/effect.hpp"

namespace abbe {

/// d in W, mm, of a guide along `axis` (0 or 1) with `curvature_per_mm`, positive for an arch.
constexpr Vec3 bent_guide(const TouchScene& scene, int axis, double curvature_per_mm) {
  const double s = scene.reading[axis], slope = curvature_per_mm * s;
  const Vec3& lever = scene.lever_mm[axis];
  Vec3 d{0, 0, scene.side[axis] * slope * s / 2 + slope * lever[axis]};
  d[axis] = -slope * lever.z;
  return d;
}

/// Curvature, per mm, of a free plate of uniform gradient: one face is `difference_K` warmer than
/// the other, `thickness_mm` away.
constexpr double thermal_curvature(double cte_ppm_per_K, double difference_K, double thickness_mm) {
  return cte_ppm_per_K * 1e-6 * difference_K / thickness_mm;
}

}  // namespace abbe
