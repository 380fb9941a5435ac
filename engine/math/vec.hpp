// Plain vectors, rotations and rigid transforms.
//
// Notation (docs/notation.md): R_AB turns coordinates in frame B into coordinates in frame A; X_AB = [R_AB | p_AB]
// is the pose of B in A; p_PQ_W is the vector from P to Q written in W. Inner letters cancel: X_WP * X_PD = X_WD.
//
// No library types here: lane kernels (engine/lanes) include this header and must stay free of them.
// Lengths are mm, angles rad, throughout the engine.
#pragma once

#include <cmath>
#include <vector>

namespace abbe {

struct Vec3 {
  double x = 0, y = 0, z = 0;

  constexpr double& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  constexpr double operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  constexpr Vec3& operator+=(const Vec3& b) { return x += b.x, y += b.y, z += b.z, *this; }
  constexpr Vec3& operator-=(const Vec3& b) { return x -= b.x, y -= b.y, z -= b.z, *this; }
  constexpr Vec3& operator*=(double s) { return x *= s, y *= s, z *= s, *this; }
  constexpr bool operator==(const Vec3&) const = default;
};

constexpr Vec3 operator+(Vec3 a, const Vec3& b) { return a += b; }
constexpr Vec3 operator-(Vec3 a, const Vec3& b) { return a -= b; }
constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3 operator*(double s, Vec3 a) { return a *= s; }
constexpr Vec3 operator*(Vec3 a, double s) { return a *= s; }
constexpr Vec3 operator/(Vec3 a, double s) { return {a.x / s, a.y / s, a.z / s}; }

constexpr double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm(const Vec3& a) { return std::sqrt(dot(a, a)); }
/// a / |a|. The zero vector gives NaN components: callers check first where a user could cause it.
inline Vec3 unit(const Vec3& a) { return a / norm(a); }
inline Vec3 mean_of(const std::vector<Vec3>& list) {
  Vec3 mean;
  for (const Vec3& v : list) mean += v / static_cast<double>(list.size());
  return mean;
}
/// The part of `a` perpendicular to the unit vector `n`.
constexpr Vec3 perpendicular_part(const Vec3& a, const Vec3& n) { return a - dot(a, n) * n; }
/// Some unit vector perpendicular to the unit vector `n`; the same one for the same `n`.
inline Vec3 any_perpendicular(const Vec3& n) {
  const double ax = std::fabs(n.x), ay = std::fabs(n.y), az = std::fabs(n.z);
  const Vec3 e = ax <= ay && ax <= az ? Vec3{1, 0, 0} : ay <= az ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  return unit(perpendicular_part(e, n));
}

/// A 3 x 3 matrix by columns; as a rotation R_AB the columns are the axes of B written in A.
struct Mat3 {
  Vec3 cx{1, 0, 0}, cy{0, 1, 0}, cz{0, 0, 1};
};

constexpr Vec3 operator*(const Mat3& m, const Vec3& v) {
  return {m.cx.x * v.x + m.cy.x * v.y + m.cz.x * v.z, m.cx.y * v.x + m.cy.y * v.y + m.cz.y * v.z,
          m.cx.z * v.x + m.cy.z * v.y + m.cz.z * v.z};
}
constexpr Mat3 operator*(const Mat3& a, const Mat3& b) { return {a * b.cx, a * b.cy, a * b.cz}; }
constexpr Mat3 transpose(const Mat3& m) {
  return {{m.cx.x, m.cy.x, m.cz.x}, {m.cx.y, m.cy.y, m.cz.y}, {m.cx.z, m.cy.z, m.cz.z}};
}
/// Right-handed rotation by `angle_rad` about the unit vector `axis` (Rodrigues).
inline Mat3 rotation(const Vec3& axis, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad), k = 1 - c;
  const Vec3 a = axis;
  return {{c + a.x * a.x * k, a.y * a.x * k + a.z * s, a.z * a.x * k - a.y * s},
          {a.x * a.y * k - a.z * s, c + a.y * a.y * k, a.z * a.y * k + a.x * s},
          {a.x * a.z * k + a.y * s, a.y * a.z * k - a.x * s, c + a.z * a.z * k}};
}
/// By how much a rotation turns, from 0 to pi.
inline double turn_rad(const Mat3& R) {
  const Vec3 twice_sine{R.cy.z - R.cz.y, R.cz.x - R.cx.z, R.cx.y - R.cy.x};
  return std::atan2(norm(twice_sine), R.cx.x + R.cy.y + R.cz.z - 1);
}

/// The pose X_AB of frame B in frame A: p_A = R_AB p_B + p_AB.
struct Rigid {
  Mat3 R;
  Vec3 p;
};

constexpr Vec3 operator*(const Rigid& X, const Vec3& point) { return X.R * point + X.p; }
constexpr Rigid operator*(const Rigid& X_AB, const Rigid& X_BC) { return {X_AB.R * X_BC.R, X_AB.R * X_BC.p + X_AB.p}; }
constexpr Rigid inverse(const Rigid& X_AB) {
  const Mat3 R_BA = transpose(X_AB.R);
  return {R_BA, -(R_BA * X_AB.p)};
}

inline constexpr double kPi = 3.14159265358979323846;

}  // namespace abbe
