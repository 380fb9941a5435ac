// The minimum of the sum of squared orthogonal distances, next to a start, for one set of points. Two stages:
//
//   descend  Levenberg-Marquardt in double: safe from far away (Marquardt 1963; More 1978 for the scaling by columns)
//   polish   Newton with the exact Hessian in extended precision: converges quadratically also when the residuals are large,
//            where Gauss-Newton would creep, and tells a minimum from a saddle
//
// On a short arc a larger radius and an axis farther away are nearly the same change, and to solve for the
// two of them is hopeless long before the points leave the element open. So here the first size changes with
// the surface held where it is next to the points, which leaves its curvature as the unknown (as in Lukacs,
// Marshall, Martin: Geometric least-squares fitting of spheres, cylinders, cones and tori, RECCAD 1997).
#pragma once

#include <algorithm>
#include <iterator>

#include "engine/features/cloud.hpp"
#include "engine/features/revolution.hpp"
#include "engine/math/cholesky.hpp"
#include "engine/math/jet.hpp"

namespace abbe {

template <class Profile, class Real>
Real sum_of_squares(const Points<Real>& points, const Placed<Real>& s) {
  Real ready[3] = {}, sum = 0;
  Profile::prepare(s.size, ready);
  for (const auto& point : points) {
    Real q[3];
    s.coordinates(point.data(), q);
    const Real d = Profile::slopes(std::sqrt(q[0] * q[0] + q[1] * q[1]), q[2], ready).d;
    sum += d * d;
  }
  return sum;
}

/// Sizes that describe an element at all.
template <class Profile, class Real>
bool meaningful(const Placed<Real>& s) {
  if (!(s.size[0] > 0)) return false;
  if constexpr (Profile::kShape == Shape::torus) return s.size[1] > 0;
  if constexpr (Profile::kShape == Shape::cone) return std::fabs(s.size[1]) < Real(1.57);
  return true;
}

/// Of a radius, in extents of the points. The arc of such a circle within them is straight but for an atom, and the
/// differences that make distances from its axis lose their digits.
inline constexpr double kLargest = 1e7;

/// Whether points of this extent can tell the size.
template <class Profile, class Real>
bool measurable(const Placed<Real>& s, Real extent) {
  return meaningful<Profile>(s) && s.size[0] <= Real(kLargest) * extent;
}

/// How many of the first unknowns are shifts that hold the surface: all directions for a sphere, across the
/// axis for the others.
template <class Profile>
inline constexpr int kHolds = Profile::kShape == Shape::sphere ? 3 : 2;
template <class Profile>
inline constexpr int kFirstSize = kUnknowns<Profile> - Profile::kSizes;

/// A torus far from its centre: its tilts, too, turn about the mean of the points.
template <class Profile>
inline constexpr bool kLifts = Profile::kAlong&& Profile::kTilt;

/// The shifts by which the surface stays where it is next to the mean of the points when size[0] grows by 1.
/// With a tilt of a torus goes the shift along the axis that leaves the mean where it is.
template <class Profile, class Real>
struct Hold {
  Real shift[kHolds<Profile>];
  Real mean[3];  ///< of the points, frame of the surface; across the axis also the lift for a tilt
  explicit Hold(const Placed<Real>& s) {
    constexpr Real origin[3] = {0, 0, 0};
    s.coordinates(origin, mean);
    Real away2 = Real(1e-300);  // with the mean on the axis nothing holds the surface, and the element is round
    for (int i = 0; i < kHolds<Profile>; ++i) away2 += mean[i] * mean[i];
    Real away = std::sqrt(away2);
    if constexpr (Profile::kShape == Shape::cone) away *= std::cos(s.size[1]);
    for (int i = 0; i < kHolds<Profile>; ++i) shift[i] = -mean[i] / away;
  }
  /// From derivatives for a change of one unknown alone to such with the surface held.
  void apply(Real (&row)[kUnknowns<Profile> + 1]) const {
    for (int i = 0; i < kHolds<Profile>; ++i) row[kFirstSize<Profile>] += shift[i] * row[i];
    if constexpr (kLifts<Profile>) row[3] += mean[0] * row[2], row[4] += mean[1] * row[2];
  }
};

/// Takes a step in the unknowns so defined.
template <class Profile, class Real>
void move_held_by(Placed<Real>& s, const Real (&step)[kUnknowns<Profile>]) {
  const Hold<Profile, Real> hold(s);
  Real free[kUnknowns<Profile>];
  std::copy(std::begin(step), std::end(step), free);
  for (int i = 0; i < kHolds<Profile>; ++i) free[i] += hold.shift[i] * step[kFirstSize<Profile>];
  if constexpr (kLifts<Profile>) {  // all the way, not to first order: a sector of a large torus rolls far about itself
    Real q[3];
    for (int k = 0; k < 3; ++k) q[k] = hold.mean[k] - free[k], free[k] = 0;
    move_by<Profile>(s, free);
    for (int i = 0; i < 3; ++i) s.p[i] = -q[0] * s.axes[0][i] - q[1] * s.axes[1][i] - q[2] * s.axes[2][i];
  } else {
    move_by<Profile>(s, free);
  }
}

/// Gauss-Newton equations J^T J x = -J^T d.
template <class Profile, class Real>
SymmetricSystem<Real, kUnknowns<Profile>> normal_equations(const Points<Real>& points, const Placed<Real>& s) {
  constexpr int N = kUnknowns<Profile>;
  SymmetricSystem<Real, N> system;
  const Hold<Profile, Real> hold(s);
  Real ready[3] = {};
  Profile::prepare(s.size, ready);
  for (const auto& point : points) {
    Real q[3], row[N + 1];
    s.coordinates(point.data(), q);
    distance_row<Profile>(q[0], q[1], q[2], ready, row);
    hold.apply(row);
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j <= i; ++j) system.a[i][j] += row[i] * row[j];
      system.b[i] -= row[i] * row[N];
    }
  }
  return system;
}

/// The distance of the point q (frame of the surface) as a function of the unknowns, in any scalar type:
/// motion first, then profile. The long way round, for derivatives that do not rest on distance_row.
template <class Profile, class T, class Real>
T displaced_distance(const Real (&q)[3], const T (&unknown)[kUnknowns<Profile>], const Real* size) {
  using std::sqrt;
  int k = 0;
  T w[3] = {T(q[0]), T(q[1]), T(q[2])}, tilt[2] = {T(0), T(0)};
  if constexpr (Profile::kAcross) w[0] = w[0] - unknown[k], w[1] = w[1] - unknown[k + 1], k += 2;
  if constexpr (Profile::kAlong) w[2] = w[2] - unknown[k], k += 1;
  if constexpr (Profile::kTilt) tilt[0] = unknown[k], tilt[1] = unknown[k + 1], k += 2;
  T sizes[2] = {T(size[0]) + unknown[k], T(size[1])};
  if constexpr (Profile::kSizes == 2) sizes[1] = sizes[1] + unknown[k + 1];
  // Cross and dot product with the axis (a, b, 1), whose squared length is 1 + a^2 + b^2.
  const T length2 = T(1) + tilt[0] * tilt[0] + tilt[1] * tilt[1];
  const T cx = w[1] - w[2] * tilt[1], cy = w[2] * tilt[0] - w[0], cz = w[0] * tilt[1] - w[1] * tilt[0];
  const T inverse2 = reciprocal(length2);
  const T rho2 = (cx * cx + cy * cy + cz * cz) * inverse2;
  const T h = (w[0] * tilt[0] + w[1] * tilt[1] + w[2]) * sqrt(inverse2);
  return Profile::distance(rho2, h, sizes);
}

/// Newton's equations H x = -g of half the sum of squares, H exact.
template <class Profile, class Real>
SymmetricSystem<Real, kUnknowns<Profile>> newton_equations_by_jets(const Points<Real>& points, const Placed<Real>& s) {
  constexpr int N = kUnknowns<Profile>;
  SymmetricSystem<Real, N> system;
  Jet<Real, N> zero[N];
  for (int i = 0; i < N; ++i) zero[i] = Jet<Real, N>::unknown(0, i);
  const Hold<Profile, Real> hold(s);
  for (int i = 0; i < kHolds<Profile>; ++i) zero[i].gradient[kFirstSize<Profile>] = hold.shift[i];
  if constexpr (kLifts<Profile>) zero[2].gradient[3] = hold.mean[0], zero[2].gradient[4] = hold.mean[1];
  for (const auto& point : points) {
    Real q[3];
    s.coordinates(point.data(), q);
    const Jet<Real, N> d = displaced_distance<Profile>(q, zero, s.size);
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j <= i; ++j) system.a[i][j] += d.gradient[i] * d.gradient[j] + d.value * d.hessian[i][j];
      system.b[i] -= d.gradient[i] * d.value;
    }
  }
  return system;
}

/// The same of what has no axis, a circle or a sphere: of |q| - r only the second derivatives by a shift, (1 - n n') / |q|,
/// are not 0.
template <class Profile, class Real>
SymmetricSystem<Real, kUnknowns<Profile>> newton_equations_of_ball(const Points<Real>& points, const Placed<Real>& s) {
  constexpr int N = kUnknowns<Profile>, D = kHolds<Profile>;
  static_assert(!Profile::kTilt && N == D + 1);
  SymmetricSystem<Real, N> system;
  const Hold<Profile, Real> hold(s);
  Real curvature[D][D] = {};
  for (const auto& point : points) {
    Real q[3], row[N + 1], n[D], away2 = 0;
    s.coordinates(point.data(), q);
    for (int i = 0; i < D; ++i) away2 += q[i] * q[i];
    const Real away = std::sqrt(away2), d = away - s.size[0];
    for (int i = 0; i < D; ++i) n[i] = q[i] / away, row[i] = -n[i];
    row[D] = -1;
    hold.apply(row);
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j <= i; ++j) system.a[i][j] += row[i] * row[j];
      system.b[i] -= row[i] * d;
    }
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j) curvature[i][j] += d / away * (Real(i == j) - n[i] * n[j]);
  }
  for (int i = 0; i < D; ++i) {  // with the size goes the shift that holds the surface
    for (int j = 0; j <= i; ++j) system.a[i][j] += curvature[i][j];
    for (int j = 0; j < D; ++j) {
      system.a[D][i] += curvature[i][j] * hold.shift[j];
      system.a[D][D] += hold.shift[i] * curvature[i][j] * hold.shift[j];
    }
  }
  return system;
}

template <class Profile, class Real>
SymmetricSystem<Real, kUnknowns<Profile>> newton_equations(const Points<Real>& points, const Placed<Real>& s) {
  if constexpr (Profile::kTilt)
    return newton_equations_by_jets<Profile>(points, s);
  else
    return newton_equations_of_ball<Profile>(points, s);
}

/// How far a step moves the surface at the points, unknown by unknown, mm.
template <class Real, int N>
Real step_length(const SymmetricSystem<Real, N>& gauss, const Real (&step)[N], std::size_t points) {
  Real length = 0;
  for (int i = 0; i < N; ++i) {
    const Real moved = std::fabs(step[i]) * std::sqrt(gauss.a[i][i] / static_cast<Real>(points));
    length = moved > length ? moved : length;
  }
  return length;
}

template <class Real>
Real distance_from_origin(const Placed<Real>& s) {
  return std::sqrt(s.p[0] * s.p[0] + s.p[1] * s.p[1] + s.p[2] * s.p[2]);
}

/// Levenberg-Marquardt from `s`; returns the sum of squares reached.
template <class Profile>
double descend(const Points<double>& points, double extent, Placed<double>& s, int iterations) {
  constexpr int N = kUnknowns<Profile>;
  constexpr double origin[3] = {0, 0, 0};
  anchor_near<Profile>(s, origin);
  double cost = sum_of_squares<Profile>(points, s), damping = 1e-4;
  for (int i = 0; i < iterations; ++i) {
    const auto gauss = normal_equations<Profile>(points, s);
    bool better = false;
    for (; !better && damping < 1e12; damping = better ? damping * 0.1 : damping * 8) {
      auto damped = gauss;
      for (int k = 0; k < N; ++k) damped.a[k][k] *= 1 + damping;
      double step[N];
      if (!solve_positive_definite(damped, step, 1e-15)) continue;
      Placed<double> trial = s;
      move_held_by<Profile>(trial, step);
      anchor_near<Profile>(trial, origin);
      const double reached = measurable<Profile>(trial, extent) ? sum_of_squares<Profile>(points, trial) : INFINITY;
      const double length = step_length(gauss, step, points.size());
      better = reached < cost;
      if (better) s = trial, cost = reached;
      if (length < 1e-9 * extent) return cost;
    }
    if (!better) return cost;
  }
  return cost;
}

/// Newton from `s`. False when it does not settle in a minimum that the points determine.
template <class Profile>
bool polish(const Points<Extended>& points, Extended extent, Placed<Extended>& s) {
  constexpr int N = kUnknowns<Profile>;
  constexpr Extended origin[3] = {0, 0, 0};
  constexpr Extended least_pivot = 1e-16L;
  Extended before = INFINITY;
  for (int i = 0; i < 60; ++i) {
    const auto gauss = normal_equations<Profile>(points, s);
    Extended step[N];
    const bool minimum = solve_positive_definite(newton_equations<Profile>(points, s), step, least_pivot);
    if (!minimum && !solve_positive_definite(gauss, step, least_pivot)) return false;
    const Extended length = step_length(gauss, step, points.size());
    if (!(length < extent)) return false;
    move_held_by<Profile>(s, step);
    anchor_near<Profile>(s, origin);
    if (!measurable<Profile>(s, extent)) return false;
    // what the differences that make a distance are rounded to
    const Extended reach = std::max(extent, distance_from_origin(s));
    if (length < 1e-18L * reach || (length >= before && length < 1e-14L * reach)) return minimum;
    before = length;
  }
  return false;
}

}  // namespace abbe
