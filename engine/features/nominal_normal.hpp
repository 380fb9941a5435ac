// Which way the surface faces where a touch gives no vector: the nominal of the feature says.
#pragma once

#include "engine/features/feature.hpp"

namespace abbe {

/// The normal out of the material at the nominal surface nearest to `point`, same frame, mm; a unit vector. Fails where
/// FeatureKind::normal does.
inline Outcome<Vec3> nominal_normal(const FeatureKind& kind, const Element& nominal, bool inner, const Vec3& point) {
  const Outcome<Vec3> out = kind.normal(nominal, point);
  return out && inner ? Outcome<Vec3>{-out.value} : out;
}

// FeatureKind::normal of several kinds.

/// Of points and planes.
inline Outcome<Vec3> along_direction(const Element& nominal, const Vec3&) { return {nominal.direction}; }

/// Along `out`, from the middle of a round feature to the point.
inline Outcome<Vec3> away_along(const Vec3& out) {
  if (norm(out) == 0)
    return Outcome<Vec3>::failed("the point lies on the axis of the feature: give the vector in PTMEAS");
  return {unit(out)};
}

/// Of circles and cylinders.
inline Outcome<Vec3> away_from_axis(const Element& nominal, const Vec3& point) {
  return away_along(perpendicular_part(point - nominal.point, nominal.direction));
}

}  // namespace abbe
