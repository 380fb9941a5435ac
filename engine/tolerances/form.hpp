// What is said of the touches of a flat feature themselves, for several kinds of tolerances.
#pragma once

#include <vector>

#include "engine/tolerances/tolerance.hpp"

namespace abbe {

/// Whether there are touches and all are made from the same side: those of a pair of planes are not, and
/// a constructed feature has none.
bool are_of_one_face(std::span<const TouchedPoint>);

/// The extent of points along the unit vector w. There must be some.
double range_along(const Vec3& w, std::span<const Vec3>);
/// The same of the touches.
double range_along(const Vec3& w, std::span<const TouchedPoint>);

/// What of the first feature, a plane, a zone must hold: the touches of a measured face; of a median plane
/// the touches of its two faces, each at its foot on the plane (the derived median surface lies between them;
/// ISO 17450-1: derived feature). None of another constructed plane.
std::vector<Vec3> points_of_plane(const EvaluationInput&);

/// Why a constructed plane may have no zone.
inline constexpr const char* kUnknownExtent = "the extent of the feature is not known, so that it has no zone";

/// The unit vector across v in which touches of a line of a surface deviate: that part of their common normal.
/// Nothing where they have several normals (an axis), or one along v.
std::optional<Vec3> section_normal(std::span<const TouchedPoint>, const Vec3& v);

/// How wide the zone about the first feature, a fitted line, is that holds its touches (ISO 1101:2017, clause 17).
///
/// A line of a surface is touched from one side: all touches have one normal, and the zone is two
/// parallel lines in the section that line and normal span. Every other line, an axis through
/// centres for one, has a cylinder as its zone.
double straightness(const EvaluationInput&);

}  // namespace abbe
