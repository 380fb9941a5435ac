// Lines and planes over lanes: one pass of second moments in the frame of the nominal, where the off-diagonal
// moments are small and so lose nothing to rounding, then the eigenvectors lane by lane. No iteration and no
// start needed but for the sense.
#pragma once

#include "engine/features/feature.hpp"

namespace abbe {

/// FeatureKind::fit_lanes of the line and the plane.
void fit_line_lanes(const PointColumns&, const Element* start, Element* result, const char** failure);
void fit_plane_lanes(const PointColumns&, const Element* start, Element* result, const char** failure);

/// FeatureKind::fit_points of the line and the plane.
FitSolution fit_line_points(const FitProblem&, Cloud, const Element* start);
FitSolution fit_plane_points(const FitProblem&, Cloud, const Element* start);

}  // namespace abbe
