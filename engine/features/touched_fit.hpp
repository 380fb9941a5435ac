// The fit of what an error-free machine has touched: the best element, and of several the one that is meant.
#pragma once

#include <vector>

#include "engine/features/fit.hpp"

namespace abbe {

/// Of the same shape. `normals`: the vectors of the touches, a unit vector for each point, either sign. Same frame, mm. Few
/// points lie on several cylinders (the corners of a box on three), whose coordinates a program writes with few decimals, so
/// that the wrong one may fit best; and nominals in real programs are often dummies. So what is looked for is an element whose
/// surface faces where the vectors point, next to the nominal, next to the touches, and from the points alone; without any the
/// one that fits best is meant. Of those that fit alike the one next to the nominal is.
FitSolution fit_touched(Shape, const std::vector<Vec3>& points, const std::vector<Vec3>& normals,
                        const Element& nominal);

}  // namespace abbe
