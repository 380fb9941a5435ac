#include "engine/features/starts.hpp"

#include <Eigen/Dense>

#include "engine/features/descend.hpp"
#include "engine/lanes/random.hpp"

namespace abbe {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Placed<double> frame_along(const Vec3& axis) {
  return placed(Shape::cylinder, {.point = {}, .direction = axis, .size = 1}, {});
}

/// Least squares of m x = b, in the columns' own scales.
VectorXd least_squares(const MatrixXd& m, const VectorXd& b) { return m.colPivHouseholderQr().solve(b); }

Vec3 vec(const Extended (&d)[3]) { return {double(d[0]), double(d[1]), double(d[2])}; }
Vec3 vec(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }

/// Algebraic circle (dimension 2: rows x, y) or sphere (3): |q|^2 = 2 c q + k, linear in c and k (Kasa 1976).
struct Ball {
  double centre[3] = {};
  double radius = 0;
};
Ball algebraic_ball(const MatrixXd& q) {
  const auto dimension = q.cols();
  MatrixXd m(q.rows(), dimension + 1);
  m << 2 * q, VectorXd::Ones(q.rows());
  const VectorXd x = least_squares(m, q.rowwise().squaredNorm());
  Ball ball;
  double radius2 = x[dimension];
  for (int k = 0; k < dimension; ++k) ball.centre[k] = x[k], radius2 += x[k] * x[k];
  ball.radius = std::sqrt(std::max(radius2, 0.0));
  return ball;
}

/// Coordinates of the points in the frame `s`, one point a row.
MatrixXd coordinates_in(const Placed<double>& s, const Points<double>& points) {
  MatrixXd q(points.size(), 3);
  for (int i = 0; i < q.rows(); ++i) {
    double row[3];
    s.coordinates(points[i].data(), row);
    for (int k = 0; k < 3; ++k) q(i, k) = row[k];
  }
  return q;
}

void shift(Placed<double>& s, double x, double y, double z) {
  for (int i = 0; i < 3; ++i) s.p[i] += x * s.axes[0][i] + y * s.axes[1][i] + z * s.axes[2][i];
}

/// Noise on a short arc pulls the algebraic radius in: the same ball, farther away, too.
Starts ball_starts(Placed<double> frame, const Points<double>& points, int dimension) {
  const Ball ball = algebraic_ball(coordinates_in(frame, points).leftCols(dimension));
  Starts list;
  for (const double farther : {1.0, 3.0, 10.0}) {
    Placed<double> s = frame;
    shift(s, farther * ball.centre[0], farther * ball.centre[1], farther * ball.centre[2]);
    s.size[0] = farther * ball.radius;
    list.push_back(s);
  }
  return list;
}

/// On a shallow arc (dimension 2) or cap (3) the heights over the chord grow with the square of the distance,
/// over 2 radii. Unlike the algebraic ball it takes all errors to be those of the heights, as they are there:
/// the radius is right however flat it is.
Placed<double> shallow_ball(const Points<double>& points, const Spread<Extended>& spread, int dimension,
                            Placed<double> frame) {
  const Vec3 normal = vec(spread.direction[dimension - 1]);
  MatrixXd m(points.size(), dimension + 1);
  VectorXd height(points.size());
  for (int i = 0; i < m.rows(); ++i) {
    double chord2 = 0;
    for (int k = 0; k < dimension - 1; ++k) {
      m(i, k) = dot(vec(points[i]), vec(spread.direction[k]));
      chord2 += m(i, k) * m(i, k);
    }
    m(i, dimension - 1) = chord2;
    m(i, dimension) = 1;
    height[i] = dot(vec(points[i]), normal);
  }
  const VectorXd f = least_squares(m, height);
  const double signed_radius = 1 / (2 * f[dimension - 1]);
  for (int k = 0; k < 3; ++k) frame.p[k] = (f[dimension] + signed_radius) * normal[k];
  frame.size[0] = std::fabs(signed_radius);
  return frame;
}

/// A narrow patch looks like a quadric over its plane.
struct Patch {
  Vec3 normal, principal[2];  ///< unit
  double curvature[2] = {};   ///< along the principal directions, 1/mm; positive towards the normal
};
Patch patch_of(const Points<double>& points, const Spread<Extended>& spread) {
  const Vec3 x = vec(spread.direction[0]), y = vec(spread.direction[1]), n = vec(spread.direction[2]);
  const double length = double(spread.along[0]), width = double(spread.along[1]);
  MatrixXd m(points.size(), 6);
  VectorXd height(points.size());
  for (int i = 0; i < m.rows(); ++i) {
    const Vec3 p = vec(points[i]);
    const double u = dot(p, x) / length, v = dot(p, y) / width;
    m.row(i) << 1, u, v, u * u, 2 * u * v, v * v;
    height[i] = dot(p, n);
  }
  const VectorXd f = least_squares(m, height);
  const double a = 2 * f[3] / (length * length), b = 2 * f[4] / (length * width), c = 2 * f[5] / (width * width);
  const double turn = 0.5 * std::atan2(2 * b, a - c), half = std::hypot((a - c) / 2, b);
  const Vec3 first = std::cos(turn) * x + std::sin(turn) * y;
  return {n, {first, cross(n, first)}, {(a + c) / 2 + half, (a + c) / 2 - half}};
}

/// The cylinders that turn as the patch does in one principal direction, and not at all in the other.
Starts shallow_cylinders(const Patch& patch) {
  Starts list;
  for (const int turns : {0, 1}) {
    Placed<double> s = frame_along(patch.principal[1 - turns]);
    const double signed_radius = 1 / patch.curvature[turns];
    for (int k = 0; k < 3; ++k) s.p[k] = signed_radius * patch.normal[k];
    s.size[0] = std::fabs(signed_radius);
    list.push_back(s);
  }
  return list;
}

Placed<double> cylinder_along(const Vec3& axis, const Points<double>& points) {
  return ball_starts(frame_along(axis), points, 2).front();
}

/// With the axis direction z known, rho^2 = (s + h tan)^2 is linear in the shift of the axis and in the
/// coefficients of the quadratic in h; its slope at h = 0 gives the angle.
Placed<double> cone_along(const Vec3& axis, const Points<double>& points) {
  Placed<double> s = frame_along(axis);
  const MatrixXd q = coordinates_in(s, points);
  MatrixXd m(q.rows(), 5);
  m << 2 * q.leftCols(2), q.col(2).cwiseAbs2(), q.col(2), VectorXd::Ones(q.rows());
  const VectorXd x = least_squares(m, q.leftCols(2).rowwise().squaredNorm());
  const double radius = std::sqrt(std::max(x[4] + x[0] * x[0] + x[1] * x[1], 0.0));
  shift(s, x[0], x[1], 0);
  s.size[1] = std::atan(x[3] / (2 * radius));
  s.size[0] = radius * std::cos(s.size[1]);
  return s;
}

/// The circle through the points seen along the axis, then the circle through their profile about it.
Placed<double> torus_along(const Vec3& axis, const Points<double>& points) {
  Placed<double> s = cylinder_along(axis, points);
  const MatrixXd q = coordinates_in(s, points);
  MatrixXd profile(q.rows(), 2);
  profile << q.leftCols(2).rowwise().norm(), q.col(2);
  const Ball tube = algebraic_ball(profile);
  shift(s, 0, 0, tube.centre[1]);
  s.size[0] = tube.centre[0];
  s.size[1] = tube.radius;
  return s;
}

/// A cylinder bent to a torus: `turn` says in which direction of its frame the centre lies.
Placed<double> bent(const Placed<double>& tube, double major_radius, double turn) {
  const double c = std::cos(turn), s = std::sin(turn);
  Placed<double> torus = tube;
  double axis[3];
  for (int k = 0; k < 3; ++k) axis[k] = c * tube.axes[1][k] - s * tube.axes[0][k];
  torus.size[0] = major_radius;
  torus.size[1] = tube.size[0];
  shift(torus, major_radius * c, major_radius * s, 0);
  for (int k = 0; k < 3; ++k) torus.axes[0][k] = tube.axes[2][k];
  point_axis(torus, axis);
  return torus;
}

/// A sector of a torus is a bent cylinder: the tubes of the cylinders given, bent to several radii in several
/// directions.
Starts bent_tubes(const Starts& cylinders, double extent) {
  Starts list;
  for (const Placed<double>& tube : cylinders)
    for (const double bend : {0.7, 1.2, 2.0, 4.0, 10.0})
      for (int turn = 0; turn < 16; ++turn) list.push_back(bent(tube, bend * extent + tube.size[0], kPi * turn / 8));
  return list;
}

/// A short sector of a large torus: the axis of the cylinder departs from its line with the square of the
/// height, which the distances of the points from the cylinder show.
Placed<double> slightly_bent(const Placed<double>& tube, const Points<double>& points) {
  const MatrixXd q = coordinates_in(tube, points);
  const VectorXd rho = q.leftCols(2).rowwise().norm(), h = q.col(2);
  const MatrixXd radial = q.leftCols(2).array().colwise() / rho.array();
  MatrixXd m(q.rows(), 7);
  m << radial, radial.array().colwise() * h.array(), radial.array().colwise() * h.array().square(),
      VectorXd::Ones(q.rows());
  const VectorXd x = least_squares(m, rho.array() - tube.size[0]);
  return bent(tube, 1 / (2 * std::hypot(x[4], x[5])), std::atan2(x[5], x[4]));
}

/// A torus is the quartic |q|^4 = |q|^2 (l q) + q M q + v q + k: linear in 13 coefficients, of which l = 4 c
/// gives the centre and M + 4 c c' (up to a multiple of the identity) = -4 R^2 w w' the axis and the major
/// radius.
Starts quartic_torus(const Points<double>& points) {
  if (points.size() < 14) return {};
  const MatrixXd q = coordinates_in(Placed<double>{}, points);
  const double unit = std::sqrt(q.rowwise().squaredNorm().mean());
  MatrixXd m(q.rows(), 13);
  VectorXd b(q.rows());
  for (int i = 0; i < q.rows(); ++i) {
    const Eigen::Vector3d p = q.row(i).transpose() / unit;
    const double r2 = p.squaredNorm();
    m.row(i) << r2 * p.transpose(), p[0] * p[0], p[1] * p[1], p[2] * p[2], 2 * p[0] * p[1], 2 * p[0] * p[2],
        2 * p[1] * p[2], p.transpose(), 1;
    b[i] = r2 * r2;
  }
  const VectorXd x = least_squares(m, b);
  const Eigen::Vector3d centre = x.head<3>() / 4;
  Eigen::Matrix3d quadric;
  quadric << x[3], x[6], x[7], x[6], x[4], x[8], x[7], x[8], x[5];
  quadric += 4 * centre * centre.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(quadric);  // ascending
  const Eigen::Vector3d axis = eigen.eigenvectors().col(0);
  const double major = std::sqrt((eigen.eigenvalues()[1] - eigen.eigenvalues()[0]) / 4);
  Placed<double> s = frame_along({axis[0], axis[1], axis[2]});
  for (int k = 0; k < 3; ++k) s.p[k] = centre[k] * unit;
  s.size[0] = major * unit;
  const MatrixXd local = coordinates_in(s, points);
  s.size[1] =
      ((local.leftCols(2).rowwise().norm().array() - s.size[0]).square() + local.col(2).array().square()).sqrt().mean();
  return {s};
}

/// The n-th of `count` directions spread over the half sphere (Fibonacci lattice).
Vec3 lattice_direction(int n, int count) {
  const double turn = kPi * (3 - std::sqrt(5.0)) * n, z = (n + 0.5) / count, r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

constexpr int kLattice = 200;  ///< about 10 degrees apart

/// Directions all over the half sphere.
void add_lattice(std::vector<Vec3>& axes) {
  for (int i = 0; i < kLattice; ++i) axes.push_back(lattice_direction(i, kLattice));
}

/// Rough points of a part of a torus have minima that no start near the points' own shape leads to: tori of
/// all directions and sizes whose tube passes near the points, not chosen by how well they fit.
Starts scattered_tori(double extent, int count) {
  Starts list;
  for (int i = 0; i < count; ++i) {
    Placed<double> s = frame_along(lattice_direction(i, count));
    s.size[0] = extent * std::pow(2, i % 5 - 1);
    s.size[1] = extent * (i % 2 ? 1 : 0.4);
    const double turn = 2 * kPi * (i % 7) / 7;
    shift(s, s.size[0] * std::cos(turn), s.size[0] * std::sin(turn), 0);
    list.push_back(s);
  }
  return list;
}

/// The axis of a surface of revolution lies, at a narrow patch, in the plane of the normal and of one of the
/// two principal directions (it is the other one's plane that turns).
void add_patch_axes(std::vector<Vec3>& axes, const Patch& patch) {
  for (const Vec3& along : patch.principal)
    for (int step = 0; step < 24; ++step) {
      const double tilt = kPi * step / 24;
      axes.push_back(std::cos(tilt) * along + std::sin(tilt) * patch.normal);
    }
}

/// About the normal of a thin ring, as far as its tube lets the axis lean.
std::vector<Vec3> ring_axes(const Spread<Extended>& spread) {
  const Vec3 x = vec(spread.direction[0]), y = vec(spread.direction[1]), n = vec(spread.direction[2]);
  const double lean = double(spread.along[2] / spread.along[1]);
  std::vector<Vec3> axes;
  for (const double much : {0.4, 0.8, 1.2, 1.8})
    for (int turn = 0; turn < 12; ++turn)
      axes.push_back(unit(n + much * lean * (std::cos(kPi * turn / 6) * x + std::sin(kPi * turn / 6) * y)));
  return axes;
}

/// A long thin element has another minimum wherever it tilts by its thickness over its length, and that may be
/// far less than a step of the lattice. Here the lattice is stretched as the points are, by their spread along
/// each principal direction: as much denser about the long one as they are thin.
std::vector<Vec3> slender_axes(const Spread<Extended>& spread) {
  std::vector<Vec3> axes;
  for (int i = 0; i < kLattice; ++i) {
    const Vec3 d = lattice_direction(i, kLattice);
    Vec3 axis;
    for (int k = 0; k < 3; ++k) axis += d[k] * double(spread.along[k]) * vec(spread.direction[k]);
    axes.push_back(unit(axis));
  }
  return axes;
}

/// Of a circle in the frame (dimension 2) or a sphere (3).
Starts round_starts(const Points<double>& points, const Spread<Extended>& spread, int dimension,
                    const Placed<double>& frame) {
  Starts list = ball_starts(frame, points, dimension);
  list.push_back(shallow_ball(points, spread, dimension, frame));
  return list;
}

bool has_patch(const Points<double>& points) { return points.size() >= 6; }

/// The principal directions of the points, what a patch of them suggests, and directions all over.
std::vector<Vec3> likely_axes(const Points<double>& points, const Spread<Extended>& spread) {
  std::vector<Vec3> axes;
  for (const auto& d : spread.direction) axes.push_back(vec(d));
  if (has_patch(points)) add_patch_axes(axes, patch_of(points, spread));
  add_lattice(axes);
  return axes;
}

/// One start for every axis.
template <class StartAlong>
Starts along_all(const std::vector<Vec3>& axes, const Points<double>& points, StartAlong start_along) {
  Starts along;
  for (const Vec3& axis : axes) along.push_back(start_along(axis, points));
  return along;
}

/// How many times more starts are kept: few points have many minima, and cost little.
int more_of(const Points<double>& points) { return points.size() < 16 ? 4 : 1; }

/// Adds the best `count` of the candidates to `kept`, no two with nearly the same direction and size.
template <class Profile>
void keep_best(const Starts& candidates, const Points<double>& points, int count, double apart_rad, Starts& kept) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!meaningful<Profile>(candidates[i])) continue;
    const double cost = sum_of_squares<Profile>(points, candidates[i]);
    if (std::isfinite(cost)) order.push_back({cost, i});
  }
  std::sort(order.begin(), order.end());
  Starts chosen;
  for (const auto& [cost, i] : order) {
    const Placed<double>& candidate = candidates[i];
    const double(&w)[3] = candidate.axes[2];
    const bool near = std::any_of(chosen.begin(), chosen.end(), [&](const Placed<double>& other) {
      const double(&v)[3] = other.axes[2];
      const double ratio = other.size[0] / candidate.size[0];
      return std::fabs(w[0] * v[0] + w[1] * v[1] + w[2] * v[2]) > std::cos(apart_rad) && ratio > 0.8 && ratio < 1.25;
    });
    if (!near) chosen.push_back(candidate);
    if (static_cast<int>(chosen.size()) == count) break;
  }
  kept.insert(kept.end(), chosen.begin(), chosen.end());
}

}  // namespace

Points<double> sample(const Points<double>& points, int count) {
  const auto n = points.size();
  if (n <= static_cast<std::size_t>(count)) return points;
  Points<double> chosen;
  for (int i = 0; i < count; ++i) {  // one from every stretch, at random: a regular step could meet a regular pattern
    const Philox4 bits = random_bits({.stream = stream_of("fit sample"), .site = static_cast<std::uint32_t>(i)});
    const double u = uniform_from_bits(bits.v[0], bits.v[1]);
    chosen.push_back(points[static_cast<std::size_t>((i + u) * static_cast<double>(n) / count)]);
  }
  return chosen;
}

Starts circle_starts(const Points<double>& points, const Spread<Extended>& spread, const Vec3& normal) {
  return round_starts(points, spread, 2, frame_along(normal));
}

Starts sphere_starts(const Points<double>& points, const Spread<Extended>& spread) {
  return round_starts(points, spread, 3, {});
}

Starts cylinder_starts(const Points<double>& points, const Spread<Extended>& spread) {
  const int more = more_of(points);
  Starts kept;
  keep_best<CylinderProfile>(along_all(likely_axes(points, spread), points, cylinder_along), points, 8 * more,
                             0.2 / more, kept);
  keep_best<CylinderProfile>(along_all(slender_axes(spread), points, cylinder_along), points, 8 * more, 0, kept);
  if (has_patch(points))
    for (const Placed<double>& shallow : shallow_cylinders(patch_of(points, spread))) kept.push_back(shallow);
  return kept;
}

Starts cone_starts(const Points<double>& points, const Spread<Extended>& spread) {
  const int more = more_of(points);
  Starts kept;
  keep_best<ConeProfile>(along_all(likely_axes(points, spread), points, cone_along), points, 12 * more, 0.15 / more,
                         kept);
  keep_best<ConeProfile>(along_all(slender_axes(spread), points, cone_along), points, 8 * more, 0, kept);
  return kept;
}

Starts torus_starts(const Points<double>& points, const Spread<Extended>& spread) {
  const int more = more_of(points);
  const double extent = double(spread.along[0]);
  Starts tubes = cylinder_starts(points, spread);
  if (tubes.size() > 8) tubes.resize(8);
  for (Placed<double>& cylinder : tubes) descend<CylinderProfile>(points, extent, cylinder, 30);
  Starts kept = quartic_torus(points);
  keep_best<TorusProfile>(along_all(likely_axes(points, spread), points, torus_along), points, 16 * more, 0.15 / more,
                          kept);
  keep_best<TorusProfile>(along_all(ring_axes(spread), points, torus_along), points, 12 * more, 0, kept);
  keep_best<TorusProfile>(bent_tubes(tubes, extent), points, 24 * more, 0.15 / more, kept);
  for (const Placed<double>& tube : tubes) kept.push_back(slightly_bent(tube, points));
  for (const Placed<double>& torus : scattered_tori(extent, points.size() < 64 ? 256 : 64)) kept.push_back(torus);
  return kept;
}

}  // namespace abbe
