// How vectors scatter about a point: the mean of (v - p)(v - p)'. Its eigenvalues are mean squares along its principal
// directions.
#pragma once

#include <span>

#include "engine/math/eigen3.hpp"
#include "engine/math/vec.hpp"

namespace abbe {

/// Of one vector at least; in the square of its unit, the largest first.
inline Eigen3<double> scatter_about(std::span<const Vec3> list, const Vec3& point) {
  double mean[3][3] = {};
  for (const Vec3& v : list) {
    const Vec3 d = v - point;
    const double off[3] = {d.x, d.y, d.z};
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) mean[i][k] += off[i] * off[k] / static_cast<double>(list.size());
  }
  return eigen_symmetric(mean);
}

/// The direction in which they scatter least.
inline Vec3 least_direction(const Eigen3<double>& scatter) {
  return {scatter.vector[2][0], scatter.vector[2][1], scatter.vector[2][2]};
}

}  // namespace abbe
