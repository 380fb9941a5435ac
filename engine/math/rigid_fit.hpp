// The rigid transform that carries one set of points onto another with the least sum of squares: Horn's unit
// quaternion (J. Opt. Soc. Am. A 4, 629, 1987), the eigenvector of the largest eigenvalue of a symmetric 4 x
// 4 matrix of moments, found by the QR algorithm.
#pragma once

#include <optional>
#include <vector>

#include "engine/math/vec.hpp"

namespace abbe {

/// X with `there` ~ X * `here`, point by point. Nothing for fewer than three points, or points on one line.
std::optional<Rigid> rigid_fit(const std::vector<Vec3>& here, const std::vector<Vec3>& there);

}  // namespace abbe
