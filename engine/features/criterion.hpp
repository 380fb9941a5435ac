// Fits by other criteria than least squares (GEOALG), which depend on the few outermost points only.
//
//   minimum zone           the narrowest pair of parallel, concentric or coaxial surfaces that has all
//                          points between it; the element is their middle (Chebyshev; MZ of ISO 12181,
//                          12780, 12781 and 12180). Of a line in space: the narrowest cylinder.
//   maximum inscribed      the largest circle, cylinder or sphere with no point inside (GX of ISO
//                          14405-1): the size of the largest plug
//   minimum circumscribed  the smallest one with all points inside (GN): the size of the smallest ring
//
// minimax_fit.hpp says how. The start is the least-squares element; of several local optima the one next
// to it is found, which for features with a form error that is small against their size is the only one.
//
// Points on less than half of a circle, a cylinder or a sphere stop no inscribed one: the larger, the farther beside them.
// About them the smallest one stands on the outermost points, and is smaller than what was touched.
#pragma once

#include <span>

#include "engine/features/feature.hpp"

namespace abbe {

enum class FitCriterion { least_squares, minimum_zone, maximum_inscribed, minimum_circumscribed };

/// Why features of this kind cannot be fitted so; nullptr when they can.
const char* criterion_refusal(const FeatureKind&, FitCriterion);

/// Replaces the least-squares element of the points by that of the criterion, same frame, mm. `low`
/// and `high` are the residuals of the points about it. Returns why there is none, or nullptr. Precondition: no refusal,
/// and `element` is the least-squares element.
[[nodiscard]] const char* refit(const FeatureKind&, FitCriterion, std::span<const Vec3> points, Element& element);

}  // namespace abbe
