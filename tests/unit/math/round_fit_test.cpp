#include "engine/math/round_fit.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace abbe;

TEST_CASE("points of a ball and their normals give its centre and radius") {
  const Vec3 centre{10, -20, 300};
  const std::vector<Vec3> normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, unit({1, 1, 1}), unit({-1, 2, 2})};
  for (const double radius : {12.5, -12.5}) {  // hollow: the surface lies against its normals
    std::vector<Vec3> points;
    for (const Vec3& n : normals) points.push_back(centre + radius * n);
    const RoundFit round = round_fit(points, normals);
    CHECK(round.radius == doctest::Approx(radius));
    CHECK(norm(round.centre - centre) < 1e-12);
    for (std::size_t i = 0; i < points.size(); ++i) CHECK(norm(round.rest(points[i], normals[i])) < 1e-12);
  }
}

TEST_CASE("of a cylinder the height above the middle is left along its axis") {
  const Vec3 axis = unit({1, 2, 2}), u = unit({2, 1, -2}), v = unit({2, -2, 1}), middle{5, 6, 7};
  std::vector<Vec3> points, normals;
  for (const double height : {-4.0, 4.0})
    for (int k = 0; k < 6; ++k) {
      const double angle = 1.1 * k;
      normals.push_back(std::cos(angle) * u + std::sin(angle) * v);
      points.push_back(middle + height * axis + 8 * normals.back());
    }
  const RoundFit round = round_fit(points, normals);
  CHECK(round.radius == doctest::Approx(8));
  CHECK(norm(round.centre - middle) < 1e-12);
  CHECK(norm(round.rest(points[0], normals[0]) + 4 * axis) < 1e-12);
}

TEST_CASE("a point that is off changes the radius as least squares have it") {
  // four normals square to each other: a radius is the mean of what they say, and the touch at x is 0.4 off
  const std::vector<Vec3> normals = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
  std::vector<Vec3> points;
  for (const Vec3& n : normals) points.push_back(10 * n);
  points[0] += Vec3{0.4, 0, 0};
  const RoundFit round = round_fit(points, normals);
  CHECK(round.spread == doctest::Approx(1));
  CHECK(round.radius == doctest::Approx(10.1));
  CHECK(round.centre.x == doctest::Approx(0.1));
}

TEST_CASE("a face spreads no normals, and no radius shows") {
  const std::vector<Vec3> normals(4, Vec3{0, 0, 1});
  const RoundFit round = round_fit(std::vector<Vec3>{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {9, 9, 0}}, normals);
  CHECK(round.spread == 0);
}
