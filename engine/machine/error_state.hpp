// The error state of a virtual machine (paper section 6, Fig. 6): the displacement d of the tip, measured =
// true + d, over the working volume. Only its differences show in a measurement, not its size: it is zero at
// home by definition.
#pragma once

#include <array>
#include <vector>

#include "engine/machine/geometry.hpp"

namespace abbe {

struct ErrorState {
  Vec3 tip_mm;                                    ///< seen from the mount
  std::array<std::vector<double>, 3> reading_mm;  ///< of each axis, evenly spaced from home to the end of its travel
  std::vector<Vec3> d_mm;                         ///< x by x, in these y by y, in these z by z

  const Vec3& at(std::size_t ix, std::size_t iy, std::size_t iz) const {
    return d_mm[(ix * reading_mm[1].size() + iy) * reading_mm[2].size() + iz];
  }
};

/// On a grid of `readings` (at least 2) of each axis.
ErrorState error_state(const Machine&, const GeometryCoefficients&, const Vec3& tip_mm, int readings);

}  // namespace abbe
