// What is said of the touches of a flat feature themselves, for several kinds of tolerances.
#pragma once

#include "engine/tolerances/tolerance.hpp"

namespace abbe {

/// Whether there are touches and all are made from the same side: those of a pair of planes are not, and
/// a constructed feature has none.
bool are_of_one_face(std::span<const TouchedPoint>);

/// The extent of the touches along the unit vector w. There must be some.
double range_along(const Vec3& w, std::span<const TouchedPoint>);

/// How wide the zone about the first feature, a fitted line, is that holds its touches (ISO 1101:2017, clause 17).
///
/// A line of a surface is touched from one side: all touches have one normal, and the zone is two
/// parallel lines in the section that line and normal span. Every other line, an axis through
/// centres for one, has a cylinder as its zone.
double straightness(const EvaluationInput&);

}  // namespace abbe
