// The sections in which a program touches a feature of revolution.
#pragma once

#include <span>
#include <vector>

namespace abbe {

/// Numbers of the touches of each section: those that the program put at the same height, within 0.1 mm. `heights_mm`:
/// of the touches, along the axis (of a plane that turns about it: their distances from the axis).
std::vector<std::vector<std::size_t>> sections(std::span<const double> heights_mm);

}  // namespace abbe
