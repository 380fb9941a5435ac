// The linear minimax problem: x in the box |x_k| <= 1 that makes the largest of m functions
// f_i + g_i . x smallest. It is one step of a Chebyshev fit (engine/features/criterion.cpp), the box
// being its trust region.
//
// Solved by Stiefel's exchange algorithm (E. Stiefel, Numerische Mathematik 1, 1959), the dual simplex
// method of this problem: N + 1 active constraints with multipliers >= 0 give a lower bound and a
// point; the constraint that the point violates most comes in, and the one leaves whose multiplier
// reaches zero first. The bound rises with every exchange, so the point where nothing is violated is
// the optimum. The box supplies the first active set. Ties go to the lower index: deterministic.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace abbe {

/// The function f + g . x.
template <int N>
struct MinimaxRow {
  double f = 0;
  double g[N] = {};
};

namespace detail {

/// Solves a x = b by elimination with partial pivoting; `b` becomes x. False when singular.
template <int M>
bool eliminate(double (&a)[M][M], double (&b)[M]) {
  for (int k = 0; k < M; ++k) {
    int pivot = k;
    for (int i = k + 1; i < M; ++i)
      if (std::fabs(a[i][k]) > std::fabs(a[pivot][k])) pivot = i;
    if (!(std::fabs(a[pivot][k]) > 1e-300)) return false;
    std::swap(a[k], a[pivot]);
    std::swap(b[k], b[pivot]);
    for (int i = k + 1; i < M; ++i) {
      const double factor = a[i][k] / a[k][k];
      for (int j = k; j < M; ++j) a[i][j] -= factor * a[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (int k = M - 1; k >= 0; --k) {
    for (int j = k + 1; j < M; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return true;
}

template <int N>
class Exchange {
 public:
  explicit Exchange(std::span<const MinimaxRow<N>> rows) : rows_(rows) {
    int highest = 0;
    for (int i = 1; i < count(); ++i)
      if (rows_[i].f > rows_[highest].f) highest = i;
    for (int k = 0; k < N; ++k) active_[k] = count() + 2 * k + (rows_[highest].g[k] > 0 ? 1 : 0);
    active_[N] = highest;
  }

  /// The model's largest value at the optimum; x becomes the optimum.
  double run(double (&x)[N]) {
    double size = 0;
    for (const auto& row : rows_) size = std::max(size, std::fabs(row.f));
    for (int round = 0; round < kRounds; ++round) {
      if (!solve_point()) break;
      const int worst = most_violated(4e-16 * (size + std::fabs(z_[N])));
      if (worst < 0 || !exchange(worst)) break;
    }
    for (int k = 0; k < N; ++k) x[k] = std::clamp(z_[k], -1.0, 1.0);
    return z_[N];
  }

 private:
  static constexpr int M = N + 1, kRounds = 400;

  int count() const { return static_cast<int>(rows_.size()); }

  /// Constraint c as normal . (x, t) <= limit: a row, or x_k <= 1 (even) or -x_k <= 1 (odd).
  double normal(int c, double (&n)[M]) const {
    std::fill(std::begin(n), std::end(n), 0.0);
    if (c >= count()) {
      n[(c - count()) / 2] = (c - count()) % 2 ? -1 : 1;
      return 1;
    }
    std::copy(std::begin(rows_[c].g), std::end(rows_[c].g), n);
    n[N] = -1;
    return -rows_[c].f;
  }

  bool solve_point() {
    double a[M][M];
    for (int i = 0; i < M; ++i) z_[i] = normal(active_[i], a[i]);
    return eliminate(a, z_);
  }

  int most_violated(double tolerance) const {
    int worst = -1;
    double most = tolerance;
    for (int c = 0; c < count() + 2 * N; ++c) {
      double n[M];
      double excess = -normal(c, n);
      for (int k = 0; k < M; ++k) excess += n[k] * z_[k];
      const bool active = std::find(std::begin(active_), std::end(active_), c) != std::end(active_);
      if (!active && excess > most) most = excess, worst = c;
    }
    return worst;
  }

  /// Puts `entering` in for the active constraint whose multiplier becomes zero first.
  bool exchange(int entering) {
    double columns[M][M], again[M][M], multiplier[M] = {}, share[M];
    for (int i = 0; i < M; ++i) {
      double n[M];
      normal(active_[i], n);
      for (int k = 0; k < M; ++k) columns[k][i] = again[k][i] = n[k];
    }
    multiplier[N] = -1;
    normal(entering, share);
    if (!eliminate(columns, multiplier) || !eliminate(again, share)) return false;
    int leaving = -1;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < M; ++i) {
      if (!(share[i] > 1e-14)) continue;
      const double ratio = std::max(multiplier[i], 0.0) / share[i];
      if (ratio < least) least = ratio, leaving = i;
    }
    if (leaving < 0) return false;
    active_[leaving] = entering;
    return true;
  }

  std::span<const MinimaxRow<N>> rows_;
  int active_[M];
  double z_[M] = {};
};

}  // namespace detail

/// The optimum in `x` and the largest of the functions there. At least one row.
template <int N>
double minimax_in_box(std::span<const MinimaxRow<N>> rows, double (&x)[N]) {
  return detail::Exchange<N>(rows).run(x);
}

}  // namespace abbe
