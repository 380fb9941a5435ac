// Small symmetric positive definite systems, N known at compile time (normal equations of the fits, N <= 7).
//
// The matrix is first scaled to unit diagonal, which removes the units of the unknowns (mm beside rad) from the
// conditioning: among diagonal scalings this is within a factor N of the best one (van der Sluis 1969).
#pragma once

#include <cmath>

namespace abbe {

template <class Real, int N>
struct SymmetricSystem {
  Real a[N][N] = {};  ///< only the lower triangle, j <= i, is read
  Real b[N] = {};
};

/// Solves a x = b into `x`. False when the matrix, scaled to unit diagonal, is not positive definite by more than
/// `least_pivot`; then x is unspecified. NaN anywhere gives false.
template <class Real, int N>
bool solve_positive_definite(const SymmetricSystem<Real, N>& s, Real (&x)[N], Real least_pivot) {
  Real scale[N], l[N][N];
  for (int i = 0; i < N; ++i) {
    if (!(s.a[i][i] > 0)) return false;
    scale[i] = 1 / std::sqrt(s.a[i][i]);
  }
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j <= i; ++j) {
      Real sum = i == j ? Real(1) : s.a[i][j] * scale[i] * scale[j];
      for (int k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      if (i == j) {
        if (!(sum > least_pivot)) return false;
        l[i][i] = std::sqrt(sum);
      } else {
        l[i][j] = sum / l[j][j];
      }
    }
  }
  for (int i = 0; i < N; ++i) {
    x[i] = s.b[i] * scale[i];
    for (int k = 0; k < i; ++k) x[i] -= l[i][k] * x[k];
    x[i] /= l[i][i];
  }
  for (int i = N - 1; i >= 0; --i) {
    for (int k = i + 1; k < N; ++k) x[i] -= l[k][i] * x[k];
    x[i] /= l[i][i];
  }
  bool finite = true;
  for (int i = 0; i < N; ++i) finite = finite && std::isfinite(x[i] *= scale[i]);
  return finite;
}

}  // namespace abbe
