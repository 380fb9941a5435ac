#include "engine/lanes/distribution.hpp"

#include <cmath>

#include "engine/base/ids.hpp"
#include "engine/lanes/elementary.hpp"

namespace abbe {

namespace {

double student_t(double dof, UniformPair p) {
  const double growth = exp_bounded(-2 / dof * log_positive(p.a));
  return std::sqrt(dof * (growth - 1)) * sin_cos_pi(2 * p.b).cos;
}

/// The variance over the square of the half width; the curvilinear trapezoid has d^2 / 9 besides.
double variance_of_unit_width(Distribution distribution, double shape) {
  switch (distribution) {
    case Distribution::triangular: return 1.0 / 6;
    case Distribution::arcsine: return 1.0 / 2;
    case Distribution::trapezoidal: return (1 + shape * shape) / 6;
    default: return 1.0 / 3;
  }
}

}  // namespace

double deviation(const Deviation& d, UniformPair p) {
  const double a = 2 * p.a - 1, b = 2 * p.b - 1;
  switch (d.distribution) {
    case Distribution::normal: return d.scale * normal_quantile(p.a);
    case Distribution::student_t: return d.scale * student_t(d.shape, p);
    case Distribution::rectangular: return d.scale * a;
    case Distribution::triangular: return d.scale * (a + b) / 2;
    case Distribution::arcsine: return d.scale * sin_cos_pi(a / 2).sin;
    case Distribution::trapezoidal: return d.scale * ((1 + d.shape) * a + (1 - d.shape) * b) / 2;
    case Distribution::curvilinear_trapezoid: return (d.scale - d.shape * a) * b;
  }
  ABBE_CHECK(false);
}

double standard_deviation(const Deviation& d) {
  if (d.distribution == Distribution::normal) return d.scale;
  if (d.distribution == Distribution::student_t) return d.scale * std::sqrt(d.shape / (d.shape - 2));
  double variance = variance_of_unit_width(d.distribution, d.shape) * d.scale * d.scale;
  if (d.distribution == Distribution::curvilinear_trapezoid) variance += d.shape * d.shape / 9;
  return std::sqrt(variance);
}

double half_width_for(Distribution distribution, double shape, double u) {
  double variance = u * u;
  if (distribution == Distribution::curvilinear_trapezoid) variance -= shape * shape / 9;
  return std::sqrt(std::fmax(0, variance) / variance_of_unit_width(distribution, shape));
}

}  // namespace abbe
