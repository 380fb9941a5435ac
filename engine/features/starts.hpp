// Where to begin a fit when there is no nominal. Only good enough to lie in the basin of the global minimum:
// descend() and polish() do the rest, and fit_revolution keeps the best of several.
#pragma once

#include "engine/features/cloud.hpp"
#include "engine/features/revolution.hpp"

namespace abbe {

using Starts = std::vector<Placed<double>>;

/// Starts for an element about the mean of the points, best first. The circle is fitted across `normal` (unit).
Starts circle_starts(const Points<double>&, const Spread<Extended>&, const Vec3& normal);
Starts sphere_starts(const Points<double>&, const Spread<Extended>&);
Starts cylinder_starts(const Points<double>&, const Spread<Extended>&);
Starts cone_starts(const Points<double>&, const Spread<Extended>&);
Starts torus_starts(const Points<double>&, const Spread<Extended>&);

/// At most `count` of the points, spread over the whole list; always the same ones.
Points<double> sample(const Points<double>& points, int count);

}  // namespace abbe
