// Eigenvalues and eigenvectors of a symmetric 3 x 3 matrix by cyclic Jacobi rotations (Golub, Van Loan: Matrix
// Computations, 8.5). Unlike the closed cubic formula it keeps small eigenvalues accurate, and on a nearly
// diagonal matrix of badly scaled entries it keeps them accurate relative to themselves (Demmel, Veselic
// 1992).
#pragma once

#include <cmath>
#include <utility>

namespace abbe {

template <class Real>
struct Eigen3 {
  Real value[3];      ///< largest first
  Real vector[3][3];  ///< vector[k] belongs to value[k]; unit, mutually perpendicular
};

/// `m` is symmetric; finite entries.
template <class Real>
Eigen3<Real> eigen_symmetric(const Real (&m)[3][3]) {
  Real a[3][3];
  Eigen3<Real> e{{}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) a[i][j] = m[i][j];
  const auto rotate = [&](int p, int q) {
    if (a[p][q] == 0) return;
    const Real theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
    const Real t = (theta < 0 ? Real(-1) : Real(1)) / (std::fabs(theta) + std::hypot(theta, Real(1)));
    const Real c = 1 / std::sqrt(t * t + 1), s = t * c;
    a[p][p] -= t * a[p][q];
    a[q][q] += t * a[p][q];
    a[p][q] = a[q][p] = 0;
    const int r = 3 - p - q;
    const Real ap = a[r][p], aq = a[r][q];
    a[r][p] = a[p][r] = c * ap - s * aq;
    a[r][q] = a[q][r] = s * ap + c * aq;
    for (int k = 0; k < 3; ++k) {
      const Real vp = e.vector[p][k], vq = e.vector[q][k];
      e.vector[p][k] = c * vp - s * vq;
      e.vector[q][k] = s * vp + c * vq;
    }
  };
  for (int sweep = 0; sweep < 16 && (a[0][1] != 0 || a[0][2] != 0 || a[1][2] != 0); ++sweep) {
    rotate(0, 1);
    rotate(0, 2);
    rotate(1, 2);
  }
  for (int k = 0; k < 3; ++k) e.value[k] = a[k][k];
  const auto order = [&](int i, int j) {
    if (e.value[i] >= e.value[j]) return;
    std::swap(e.value[i], e.value[j]);
    std::swap(e.vector[i], e.vector[j]);
  };
  order(0, 1);
  order(0, 2);
  order(1, 2);
  return e;
}

}  // namespace abbe
