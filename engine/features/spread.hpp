// How points spread about their mean: the eigenvalues of their covariance say whether they are one point, a
// line or a plane, and the eigenvectors are the least-squares line and plane themselves (Pearson 1901).
#pragma once

#include <algorithm>
#include <cmath>

#include "engine/math/eigen3.hpp"

namespace abbe {

/// Root mean square spreads (mm) of n points along their principal directions, largest first, and the directions.
template <class Real>
struct Spread {
  Real along[3];
  Real direction[3][3];
};

/// From the sums of products about the mean.
template <class Real>
Spread<Real> spread_of(const Real (&products)[3][3], int n) {
  const Eigen3<Real> e = eigen_symmetric(products);
  Spread<Real> s;
  for (int i = 0; i < 3; ++i) {
    s.along[i] = std::sqrt(std::max(e.value[i], Real(0)) / n);
    for (int k = 0; k < 3; ++k) s.direction[i][k] = e.vector[i][k];
  }
  return s;
}

/// Spreads below this (mm) are rounding of the coordinates or no spread in any practical sense: 16 units in
/// the last place of the largest coordinate, or 1e-10 of the largest spread.
inline double negligible_spread(double largest_coordinate, double largest_spread) {
  return std::max(16 * 0x1p-52 * largest_coordinate, 1e-10 * largest_spread);
}

}  // namespace abbe
