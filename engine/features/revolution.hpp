// Circle, sphere, cylinder, cone and torus are surfaces of revolution: each is a profile curve turned about
// an axis. So the distance of a point from any of them is a function of two numbers only, its distance `rho`
// from the axis and its height `h` along it, and the derivatives with respect to the five motions of the axis
// (two shifts across it, one along it, two tilts) follow from the slopes of that function for all kinds at
// once:
//
//   q = the point in the frame of the surface (z = axis),  rho = |q_xy|,  h = q_z,  d = f(rho, h, sizes)
//   shift across:  dd/dx = -f_rho q_x / rho            shift along:  dd/dz = -f_h
//   tilt:          dd/da = (f_h - f_rho h / rho) q_x   (the axis becomes (a, b, 1) / |.|)
//
// A kind of surface is therefore the small struct below that gives f, its slopes and the motions that matter
// to it. The frame is moved after every step, so the derivatives are needed at zero motion only (Forbes:
// Least-squares best-fit geometric elements, NPL DITC 140/89).
#pragma once

#include <cmath>

#include "engine/features/element.hpp"

namespace abbe {

/// f and its slopes at one point.
template <class Real>
struct ProfileSlopes {
  Real d, rho, h;
  Real size[2];
};

// Members of every profile:
//   kAcross, kAlong, kTilt  which motions of the axis change the surface
//   kSizes                  how many sizes it has
//   distance                f(rho^2, h, sizes) for any scalar type: the definition (jets differentiate it)
//   prepare                 what `slopes` needs of the sizes, so that kernels call no trigonometric function
//   slopes                  f and its derivatives

/// Circle (in its plane), sizes: radius.
struct CircleProfile {
  static constexpr Shape kShape = Shape::circle;
  static constexpr bool kAcross = true, kAlong = false, kTilt = false;
  static constexpr int kSizes = 1;
  template <class T>
  static T distance(const T& rho2, const T&, const T* size) {
    using std::sqrt;
    return sqrt(rho2) - size[0];
  }
  template <class Real>
  static void prepare(const Real* size, Real* ready) {
    ready[0] = size[0];
  }
  template <class Real>
  static ProfileSlopes<Real> slopes(Real rho, Real, const Real* ready) {
    return {rho - ready[0], 1, 0, {-1, 0}};
  }
};

/// Cylinder, sizes: radius.
struct CylinderProfile : CircleProfile {
  static constexpr Shape kShape = Shape::cylinder;
  static constexpr bool kTilt = true;
};

/// Sphere, sizes: radius.
struct SphereProfile {
  static constexpr Shape kShape = Shape::sphere;
  static constexpr bool kAcross = true, kAlong = true, kTilt = false;
  static constexpr int kSizes = 1;
  template <class T>
  static T distance(const T& rho2, const T& h, const T* size) {
    using std::sqrt;
    return sqrt(rho2 + h * h) - size[0];
  }
  template <class Real>
  static void prepare(const Real* size, Real* ready) {
    ready[0] = size[0];
  }
  template <class Real>
  static ProfileSlopes<Real> slopes(Real rho, Real h, const Real* ready) {
    const Real q = std::sqrt(rho * rho + h * h);
    return {q - ready[0], rho / q, h / q, {-1, 0}};
  }
};

/// Cone, sizes: distance of the origin of the frame from the surface line, half angle.
struct ConeProfile {
  static constexpr Shape kShape = Shape::cone;
  static constexpr bool kAcross = true, kAlong = false, kTilt = true;
  static constexpr int kSizes = 2;
  template <class T>
  static T distance(const T& rho2, const T& h, const T* size) {
    using std::cos, std::sin, std::sqrt;
    return sqrt(rho2) * cos(size[1]) - h * sin(size[1]) - size[0];
  }
  template <class Real>
  static void prepare(const Real* size, Real* ready) {
    ready[0] = size[0];
    ready[1] = std::cos(size[1]);
    ready[2] = std::sin(size[1]);
  }
  template <class Real>
  static ProfileSlopes<Real> slopes(Real rho, Real h, const Real* ready) {
    const Real c = ready[1], s = ready[2];
    return {rho * c - h * s - ready[0], c, -s, {-1, -rho * s - h * c}};
  }
};

/// Torus, sizes: major radius, radius of the tube.
struct TorusProfile {
  static constexpr Shape kShape = Shape::torus;
  static constexpr bool kAcross = true, kAlong = true, kTilt = true;
  static constexpr int kSizes = 2;
  template <class T>
  static T distance(const T& rho2, const T& h, const T* size) {
    using std::sqrt;
    const T across = sqrt(rho2) - size[0];
    return sqrt(across * across + h * h) - size[1];
  }
  template <class Real>
  static void prepare(const Real* size, Real* ready) {
    ready[0] = size[0], ready[1] = size[1];
  }
  template <class Real>
  static ProfileSlopes<Real> slopes(Real rho, Real h, const Real* ready) {
    const Real across = rho - ready[0];
    const Real q = std::sqrt(across * across + h * h + Real(1e-300));
    return {q - ready[1], across / q, h / q, {-across / q, -1}};
  }
};

template <class Profile>
inline constexpr int kUnknowns = 2 * Profile::kAcross + Profile::kAlong + 2 * Profile::kTilt + Profile::kSizes;

/// The derivatives of the distance with respect to all unknowns (order: x, y, z, a, b, sizes, as far as the
/// profile has them), followed by the distance itself.
template <class Profile, class Real>
inline void distance_row(Real qx, Real qy, Real h, const Real* ready, Real (&row)[kUnknowns<Profile> + 1]) {
  // The tiny number keeps a point exactly on the axis from becoming 0/0; every other rho is unchanged by it.
  const Real rho = std::sqrt(qx * qx + qy * qy + Real(1e-300));
  const ProfileSlopes<Real> f = Profile::slopes(rho, h, ready);
  int k = 0;
  if constexpr (Profile::kAcross) row[k++] = -f.rho * qx / rho, row[k++] = -f.rho * qy / rho;
  if constexpr (Profile::kAlong) row[k++] = -f.h;
  if constexpr (Profile::kTilt) {
    const Real tilt = f.h - f.rho * h / rho;
    row[k++] = tilt * qx, row[k++] = tilt * qy;
  }
  row[k++] = f.size[0];
  if constexpr (Profile::kSizes == 2) row[k++] = f.size[1];
  row[k] = f.d;
}

/// A surface of revolution placed in space: a frame with its z along the axis, and the sizes of the profile.
template <class Real>
struct Placed {
  Real p[3] = {};  ///< origin of the frame, a point of the axis
  Real axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Real size[2] = {};

  /// Coordinates in the frame of the surface.
  void coordinates(const Real* point, Real (&q)[3]) const {
    const Real w[3] = {point[0] - p[0], point[1] - p[1], point[2] - p[2]};
    for (int k = 0; k < 3; ++k) q[k] = axes[k][0] * w[0] + axes[k][1] * w[1] + axes[k][2] * w[2];
  }
};

/// Turns the frame until its z is parallel to `z` (any length but not zero); x moves as little as may be.
template <class Real>
void point_axis(Placed<Real>& s, const Real (&z)[3]) {
  Real(&x)[3] = s.axes[0], (&y)[3] = s.axes[1], (&w)[3] = s.axes[2];
  const Real length = std::sqrt(z[0] * z[0] + z[1] * z[1] + z[2] * z[2]);
  for (int k = 0; k < 3; ++k) w[k] = z[k] / length;
  const Real along = x[0] * w[0] + x[1] * w[1] + x[2] * w[2];
  for (int k = 0; k < 3; ++k) x[k] -= along * w[k];
  const Real rest = std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
  for (int k = 0; k < 3; ++k) x[k] /= rest;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    y[k] = w[i] * x[j] - w[j] * x[i];
  }
}

/// Takes a step in the unknowns, in the order of distance_row.
template <class Profile, class Real>
void move_by(Placed<Real>& s, const Real (&step)[kUnknowns<Profile>]) {
  int k = 0;
  Real shift[3] = {};
  if constexpr (Profile::kAcross) shift[0] = step[k++], shift[1] = step[k++];
  if constexpr (Profile::kAlong) shift[2] = step[k++];
  for (int i = 0; i < 3; ++i) s.p[i] += shift[0] * s.axes[0][i] + shift[1] * s.axes[1][i] + shift[2] * s.axes[2][i];
  if constexpr (Profile::kTilt) {
    const Real a = step[k++], b = step[k++];
    Real z[3];
    for (int i = 0; i < 3; ++i) z[i] = s.axes[2][i] + a * s.axes[0][i] + b * s.axes[1][i];
    point_axis(s, z);
  }
  s.size[0] += step[k++];
  if constexpr (Profile::kSizes == 2) s.size[1] += step[k];
}

/// Slides the origin of the frame along the axis to the point nearest to `target`, without changing the
/// surface. Nothing happens to profiles for which a shift along the axis is a motion of its own.
template <class Profile, class Real>
void anchor_near(Placed<Real>& s, const Real (&target)[3]) {
  if constexpr (!Profile::kAlong) {
    Real q[3];
    s.coordinates(target, q);
    for (int i = 0; i < 3; ++i) s.p[i] += q[2] * s.axes[2][i];
    if constexpr (Profile::kShape == Shape::cone) s.size[0] += q[2] * std::sin(s.size[1]);
  }
}

/// The element, relative to `origin`, as a placed surface.
Placed<double> placed(Shape shape, const Element& e, const Vec3& origin);

/// A surface, relative to `origin`, as an element without residuals and ends. A cone of negative half angle
/// is the same cone looked at from its other side; `turned` tells whether the direction had to be turned for
/// it.
template <class Real>
Element element_of(Shape shape, const Placed<Real>& s, const Real (&origin)[3], bool* turned = nullptr) {
  const bool turn = shape == Shape::cone && s.size[1] < 0;
  if (turned) *turned = turn;
  Element e;
  for (int k = 0; k < 3; ++k) {
    e.point[k] = static_cast<double>(origin[k] + s.p[k]);
    e.direction[k] = static_cast<double>(turn ? -s.axes[2][k] : s.axes[2][k]);
  }
  e.size = static_cast<double>(shape == Shape::cone ? s.size[0] / std::cos(s.size[1]) : s.size[0]);
  if (shape == Shape::torus) e.minor_size = static_cast<double>(s.size[1]);
  if (shape == Shape::cone) e.angle = static_cast<double>(turn ? -s.size[1] : s.size[1]);
  return e;
}

}  // namespace abbe
