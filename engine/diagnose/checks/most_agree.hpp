// The rigid placement that most touches agree on, whatever a few others are: a row in micrometres lies a hundred metres off,
// and would turn the part.
#pragma once

#include <optional>
#include <vector>

#include "engine/math/vec.hpp"

namespace abbe::diagnose {

/// X with `there` ~ X * `here`, point by point, by least squares without what lies five times as far off as half of them, and
/// more than a millimetre. Nothing for fewer than three points, or points on one line.
std::optional<Rigid> placement_of_most(std::vector<Vec3> here, std::vector<Vec3> there);

}  // namespace abbe::diagnose
