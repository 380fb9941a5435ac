// Where to begin a fit when there is no nominal. Only good enough to lie in the basin of the global minimum:
// descend() and polish() do the rest, and fit_points keeps the best of several.
#pragma once

#include "engine/features/cloud.hpp"
#include "engine/features/revolution.hpp"

namespace abbe {

/// Starts for an element of `shape`, about the mean of the points, best first. The circle is fitted across
/// `normal` (unit).
std::vector<Placed<double>> starts(Shape shape, const Points<double>& points, const Spread<Extended>& spread,
                                   const std::optional<Vec3>& normal);

/// At most `count` of the points, spread over the whole list; always the same ones.
Points<double> sample(const Points<double>& points, int count);

}  // namespace abbe
