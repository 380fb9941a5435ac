#include "engine/machine/head.hpp"

#include <cmath>

namespace abbe {

Mat3 head_rotation(double a_rad, double b_rad) {
  const double ca = std::cos(a_rad), sa = std::sin(a_rad), cb = std::cos(b_rad), sb = std::sin(b_rad);
  return {{ca * cb, ca * sb, sa}, {-sb, cb, 0}, {-sa * cb, -sa * sb, ca}};
}

Vec3 head_derivative_a(double a_rad, double b_rad, const Vec3& tip_in_r) {
  const double ca = std::cos(a_rad), sa = std::sin(a_rad), cb = std::cos(b_rad), sb = std::sin(b_rad);
  const Mat3 derivative{{-sa * cb, -sa * sb, ca}, {0, 0, 0}, {-ca * cb, -ca * sb, -sa}};
  return derivative * tip_in_r;
}

Vec3 head_derivative_b(double a_rad, double b_rad, const Vec3& tip_in_r) {
  return cross({0, 0, 1}, head_rotation(a_rad, b_rad) * tip_in_r);
}

}  // namespace abbe
