// The round surface that touches were aimed at. A part that stands elsewhere is touched beside its targets, and
// where the surface bends away that is a distance along the normal: 0.4 um for 0.1 mm on a ball of 25 mm.
#pragma once

#include <optional>
#include <vector>

#include "engine/math/vec.hpp"

namespace abbe::diagnose {

/// The ball or the cylinder on which targets lie: of tip centres, that of the tip centres.
class RoundSurface {
 public:
  /// Nothing where they lie on neither, or where too few of them say so. One normal by target, of unit length.
  static std::optional<RoundSurface> through(const std::vector<Vec3>& targets_mm, const std::vector<Vec3>& normals);

  /// What bending away adds to the distance of `place` beyond the tangent plane of a target, to make it that from
  /// the surface; mm. Zero further beside the target than a quarter of the radius: no part stood so far off.
  double bend_mm(const Vec3& target_mm, const Vec3& place_mm) const;

 private:
  Vec3 middle_;               // of the ball, or a point of the axis
  std::optional<Vec3> axis_;  // of the cylinder
  double radius_mm_ = 0;      // below zero: a hollow one
};

}  // namespace abbe::diagnose
