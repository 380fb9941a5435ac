// Minimum zone, maximum inscribed and minimum circumscribed fits against exhaustive search.
#include "engine/features/criterion.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/features/fit.hpp"
#include "engine/lanes/random.hpp"
#include "engine/math/units.hpp"

using namespace abbe;
using doctest::Approx;

namespace {

using enum FitCriterion;

double uniform(std::uint32_t i) { return 2 * uniform_pair({11, i, 2, 0, 0, 0}).a - 1; }

Element least_squares_of(Shape shape, const std::vector<Vec3>& points, Vec3 normal = {0, 0, 1}) {
  FitProblem problem{shape, points, std::nullopt};
  if (shape == Shape::circle) problem.normal = normal;
  const FitSolution solution = fit_points(problem);
  REQUIRE_FALSE(solution.error.has_value());
  return solution.element;
}

Element fitted(Shape shape, FitCriterion criterion, const std::vector<Vec3>& points) {
  Element e = least_squares_of(shape, points);
  CHECK(refit(feature_kind(shape), criterion, points, e) == nullptr);
  return e;
}

/// n points near the circle of radius 25 about (40, -30), form error of some 10 um.
std::vector<Vec3> rough_circle(int n, std::uint32_t seed) {
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * kPi * i / n, r = 25 + 0.01 * uniform(1000 * seed + static_cast<std::uint32_t>(i));
    points.push_back({40 + r * std::cos(a), -30 + r * std::sin(a), 5});
  }
  return points;
}

struct Centre {
  double x, y;
};

/// The point as far from a as from b and as far from c as from d.
bool equidistant(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, Centre& out) {
  const double m[2][2] = {{b.x - a.x, b.y - a.y}, {d.x - c.x, d.y - c.y}};
  const double det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
  if (std::fabs(det) < 1e-9) return false;
  const auto half = [](const Vec3& p, const Vec3& q) { return 0.5 * (q.x * q.x + q.y * q.y - p.x * p.x - p.y * p.y); };
  const double u = half(a, b), v = half(c, d);
  out = {(u * m[1][1] - v * m[0][1]) / det, (m[0][0] * v - m[1][0] * u) / det};
  return true;
}

struct Radii {
  double low, high;
};
Radii radii(const std::vector<Vec3>& points, const Centre& c) {
  Radii r{1e300, 0};
  for (const Vec3& p : points) {
    const double rho = std::hypot(p.x - c.x, p.y - c.y);
    r.low = std::min(r.low, rho), r.high = std::max(r.high, rho);
  }
  return r;
}

/// f(centre) for every centre that the optimum can have: middles of pairs, and points equidistant in two pairs.
template <class F>
void for_candidates(const std::vector<Vec3>& p, F f) {
  const std::size_t n = p.size();
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = a + 1; b < n; ++b) {
      f(Centre{0.5 * (p[a].x + p[b].x), 0.5 * (p[a].y + p[b].y)});
      for (std::size_t c = 0; c < n; ++c)
        for (std::size_t d = c + 1; d < n; ++d) {
          Centre centre{};
          const bool near = equidistant(p[a], p[b], p[c], p[d], centre) && std::hypot(centre.x - 40, centre.y + 30) < 5;
          if (near) f(centre);
        }
    }
}

}  // namespace

TEST_CASE("Circles agree with the search over all sets of points that can define them") {
  for (std::uint32_t seed = 0; seed < 12; ++seed) {
    const std::vector<Vec3> points = rough_circle(5 + static_cast<int>(seed) % 5, seed);
    double zone = 1e300, inscribed = 0, circumscribed = 1e300;
    for_candidates(points, [&](const Centre& c) {
      const Radii r = radii(points, c);
      zone = std::min(zone, r.high - r.low);
      inscribed = std::max(inscribed, r.low);
      circumscribed = std::min(circumscribed, r.high);
    });
    CAPTURE(seed);
    const Element mz = fitted(Shape::circle, minimum_zone, points);
    CHECK(mz.high - mz.low == Approx(zone).epsilon(1e-9));
    CHECK(mz.high == Approx(-mz.low).epsilon(1e-9));
    CHECK(fitted(Shape::circle, maximum_inscribed, points).size == Approx(inscribed).epsilon(1e-11));
    CHECK(fitted(Shape::circle, minimum_circumscribed, points).size == Approx(circumscribed).epsilon(1e-11));
  }
}

TEST_CASE("A circle about two opposite points") {
  // The diameter of the farthest pair holds the others: centre half way, wherever least squares was.
  const std::vector<Vec3> points = {{-10, 0, 0}, {10, 0, 0}, {0, 9.9, 0}, {3, -9.4, 0}, {-2, 9.6, 0}};
  const Element e = fitted(Shape::circle, minimum_circumscribed, points);
  CHECK(e.size == Approx(10).epsilon(1e-13));
  CHECK(std::hypot(e.point.x, e.point.y) < 1e-6);
  CHECK(std::fabs(e.high) < 1e-12);
  CHECK(e.low < -0.09);
}

TEST_CASE("The minimum zone of a plane agrees with the search over its supporting planes") {
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    std::vector<Vec3> points;
    for (std::uint32_t i = 0; i < 9; ++i)
      points.push_back({30.0 * (i % 3), 40.0 * (i / 3), 0.02 * uniform(500 + 100 * seed + i)});
    double zone = 1e300;
    const auto width = [&](const Vec3& n) {
      if (norm(n) < 1e-9 || std::fabs(unit(n).z) < 0.9) return;
      double low = 1e300, high = -1e300;
      for (const Vec3& p : points) low = std::min(low, dot(unit(n), p)), high = std::max(high, dot(unit(n), p));
      zone = std::min(zone, high - low);
    };
    for (const Vec3& a : points)  // an edge against an edge; with c = a, a face against a point
      for (const Vec3& b : points)
        for (const Vec3& c : points)
          for (const Vec3& d : points) width(cross(b - a, d - c));
    const Element e = fitted(Shape::plane, minimum_zone, points);
    CAPTURE(seed);
    CHECK(e.high - e.low == Approx(zone).epsilon(1e-9));
    CHECK(e.high == Approx(-e.low).epsilon(1e-9));
    const Element ls = least_squares_of(Shape::plane, points);
    CHECK(e.high - e.low <= ls.high - ls.low);
    CHECK(dot(e.direction, ls.direction) > 0);
  }
}

namespace {

std::vector<Vec3> rough_cylinder(std::uint32_t seed) {
  std::vector<Vec3> points;
  for (int i = 0; i < 18; ++i) {
    const double a = 2 * kPi * (i % 6) / 6 + 0.2 * (i / 6),
                 r = 12 + 0.008 * uniform(9000 + 100 * seed + static_cast<std::uint32_t>(i));
    points.push_back({r * std::cos(a) + 3, r * std::sin(a) - 4, 20.0 * (i / 6)});
  }
  return points;
}

Radii about_axis(const std::vector<Vec3>& points, const Vec3& p, const Vec3& d) {
  Radii r{1e300, 0};
  for (const Vec3& q : points) {
    const double rho = norm(cross(q - p, d));
    r.low = std::min(r.low, rho), r.high = std::max(r.high, rho);
  }
  return r;
}

}  // namespace

TEST_CASE("No neighbour of a cylinder is better") {
  for (std::uint32_t seed = 0; seed < 5; ++seed) {
    const std::vector<Vec3> points = rough_cylinder(seed);
    const Element mz = fitted(Shape::cylinder, minimum_zone, points),
                  mi = fitted(Shape::cylinder, maximum_inscribed, points),
                  mc = fitted(Shape::cylinder, minimum_circumscribed, points),
                  ls = least_squares_of(Shape::cylinder, points);
    CHECK(mz.high - mz.low <= ls.high - ls.low);
    CHECK(mi.size < ls.size);
    CHECK(mc.size > ls.size);
    CHECK(mi.low > -1e-11);  // no point inside
    CHECK(mc.high < 1e-11);  // no point outside
    CHECK(mz.end - mz.begin == Approx(40).epsilon(1e-3));
    for (std::uint32_t trial = 0; trial < 300; ++trial) {
      const auto nudge = [&](std::uint32_t k) { return 2e-4 * uniform(50000 + 1000 * seed + 4 * trial + k); };
      const auto moved = [&](const Element& e) {
        return about_axis(points, e.point + Vec3{nudge(0), nudge(1), 0},
                          unit(e.direction + 0.05 * Vec3{nudge(2), nudge(3), 0}));
      };
      const Radii z = moved(mz);
      CHECK(z.high - z.low >= mz.high - mz.low - 1e-11);
      CHECK(moved(mi).low <= mi.size + 1e-11);
      CHECK(moved(mc).high >= mc.size - 1e-11);
    }
  }
}

TEST_CASE("Between points on less than half of a circle, a cylinder or a sphere there is no largest one") {
  // Of 20 mm radius, from 0 degrees on, at two heights, `rise` apart; 190 degrees are more than half.
  const auto refused = [](Shape shape, FitCriterion criterion, double degrees, double rise) {
    std::vector<Vec3> points;
    for (int i = 0; i < 8; ++i)
      for (const double z : {-rise, rise}) {
        const double a = degrees * kDegree * i / 7, across = shape == Shape::sphere ? std::sqrt(400 - z * z) : 20;
        points.push_back({across * std::cos(a), across * std::sin(a), z});
      }
    Element e = least_squares_of(shape, points);
    return refit(feature_kind(shape), criterion, points, e) != nullptr;
  };
  CHECK(refused(Shape::circle, maximum_inscribed, 150, 0));
  CHECK(refused(Shape::cylinder, maximum_inscribed, 150, 5));
  CHECK(refused(Shape::sphere, maximum_inscribed, 150, 5));
  CHECK_FALSE(refused(Shape::circle, maximum_inscribed, 190, 0));
  CHECK_FALSE(refused(Shape::cylinder, maximum_inscribed, 190, 5));
  CHECK_FALSE(refused(Shape::circle, minimum_circumscribed, 150, 0));
  CHECK_FALSE(refused(Shape::circle, minimum_zone, 150, 0));
}

TEST_CASE("Spheres, cones and lines in space") {
  // A cube's corners with one pulled out: the smallest sphere touches it and stays centred on the opposite ones.
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.push_back({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0});
  corners[0] = 1.01 * corners[0];
  const Element mc = fitted(Shape::sphere, minimum_circumscribed, corners);
  // Through the far corner (1.01 of -1,-1,-1) and (1,1,1): the diameter, which holds all the others? Its
  // radius is 1.005 sqrt 3.
  CHECK(mc.size == Approx(1.005 * std::sqrt(3.0)).epsilon(1e-9));
  // Three points 0, 1, 0 off a line at equal steps: half the sagitta to either side.
  const std::vector<Vec3> bowed = {{0, 0, 0}, {10, 0.1, 0}, {20, 0, 0}};
  const Element line = fitted(Shape::line, minimum_zone, bowed);
  CHECK(line.high - line.low == Approx(0.1).epsilon(1e-9));
  CHECK(line.end - line.begin == Approx(20).epsilon(1e-4));
  // Of points in a plane the strip along one edge of their outline, wherever the plane is.
  const Vec3 u = unit({1, 2, 2}), v = unit({2, 1, -2});
  const double heights[] = {-0.0197, -0.0441, -0.0115, -0.0268, 0.007, -0.0189},
               places[] = {-45, -28, -28.1, -3, 19, 30};
  std::vector<Vec3> edge;
  for (int i = 0; i < 6; ++i) edge.push_back(Vec3{700, 400, -300} + places[i] * u + heights[i] * v);
  double narrowest = 1e300;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < i; ++j) {
      const Vec3 normal = unit(cross(edge[i] - edge[j], cross(u, v)));
      double low = 1e300, high = -1e300;
      for (const Vec3& p : edge) low = std::min(low, dot(p, normal)), high = std::max(high, dot(p, normal));
      narrowest = std::min(narrowest, high - low);
    }
  const Element strip = fitted(Shape::line, minimum_zone, edge);
  CHECK(strip.high - strip.low == Approx(narrowest).epsilon(1e-9));
  double above = -1e300, below = 1e300;
  for (const Vec3& p : edge) {
    const double off = dot(p - strip.point, unit(cross(strip.direction, cross(u, v))));
    above = std::max(above, off), below = std::min(below, off);
  }
  CHECK(above == Approx(0.5 * narrowest).epsilon(1e-9));
  CHECK(below == Approx(-0.5 * narrowest).epsilon(1e-9));
  std::vector<Vec3> cone;
  for (int i = 0; i < 12; ++i) {
    const double a = 2 * kPi * (i % 4) / 4 + 0.3 * (i / 4), h = 20 + 10 * (i / 4),
                 r = 0.5 * h + 0.004 * uniform(777 + static_cast<std::uint32_t>(i));
    cone.push_back({r * std::cos(a), r * std::sin(a), h});
  }
  const Element mz = fitted(Shape::cone, minimum_zone, cone), ls = least_squares_of(Shape::cone, cone);
  CHECK(mz.high - mz.low < ls.high - ls.low);
  CHECK(mz.high == Approx(-mz.low).epsilon(1e-9));
  CHECK(mz.angle == Approx(std::atan(0.5)).epsilon(1e-3));
}

TEST_CASE("Criteria that a shape does not have are refused") {
  for (const FitCriterion c : {minimum_zone, maximum_inscribed, minimum_circumscribed}) {
    CHECK(criterion_refusal(feature_kind(Shape::point), c) != nullptr);
    CHECK(criterion_refusal(feature_kind(Shape::torus), c) != nullptr);
    CHECK(criterion_refusal(feature_kind(Shape::cylinder), c) == nullptr);
    CHECK((criterion_refusal(feature_kind(Shape::plane), c) == nullptr) == (c == minimum_zone));
  }
  CHECK(criterion_refusal(feature_kind(Shape::torus), least_squares) == nullptr);
}
