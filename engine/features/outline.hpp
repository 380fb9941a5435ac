// Slots, rectangles and ellipses: curves in a plane with a centre, a long side and two sizes. They are
// fitted by orthogonal least squares in the plane of the nominal normal, all with the same five
// unknowns: two shifts, the turn about the normal, half length and half width.
//
// For a curve that bounds a region, d is the signed distance of a point from it (outside positive), n
// its gradient there, u and v the point's coordinates along and across. To first order
//
//   dd/d(shift) = -n        dd/d(turn) = n_u v - n_v u        dd/d(sizes) as the kind says.
//
// A slot whose ends were not touched leaves its length and its place along itself open: they stay as
// the nominal has them. With one end touched the length stays.
#pragma once

#include "engine/features/feature.hpp"

namespace abbe {

/// Signed distance of a point from an outline, and its derivatives.
struct OutlineDistance {
  double d = 0;
  double nu = 0, nv = 0;         ///< gradient of d, a unit vector
  double length = 0, width = 0;  ///< dd / d(half length), dd / d(half width)
};

/// At (u, v), relative to the centre, along and across; mm.
OutlineDistance outline_distance(Shape, bool flat_ends, double u, double v, double half_length, double half_width);

/// FeatureKind::fit_lanes of outlines; `start` must be near enough that every touch lies by its side.
template <Shape shape>
void fit_outline_lanes(const PointColumns&, const Element* start, Element* result, const char** failure);

extern template void fit_outline_lanes<Shape::slot>(const PointColumns&, const Element*, Element*, const char**);
extern template void fit_outline_lanes<Shape::rectangle>(const PointColumns&, const Element*, Element*, const char**);
extern template void fit_outline_lanes<Shape::ellipse>(const PointColumns&, const Element*, Element*, const char**);

}  // namespace abbe
