#include "engine/math/scatter.hpp"

#include <doctest/doctest.h>

#include <vector>

using namespace abbe;

TEST_CASE("vectors scatter along their principal directions by their mean squares") {
  const Vec3 x = unit({1, 2, 2}), y = unit({2, 1, -2}), z = unit({2, -2, 1}), middle{10, -20, 30};
  REQUIRE(dot(x, y) == 0);
  std::vector<Vec3> list;
  for (const double sign : {-1.0, 1.0})
    for (const Vec3& v : {1.0 * x, 5.0 * y, 3.0 * z}) list.push_back(middle + sign * v);
  const Eigen3<double> scatter = scatter_about(list, middle);
  CHECK(scatter.value[0] == doctest::Approx(25.0 / 3));
  CHECK(scatter.value[1] == doctest::Approx(9.0 / 3));
  CHECK(scatter.value[2] == doctest::Approx(1.0 / 3));
  CHECK(std::fabs(dot(least_direction(scatter), x)) == doctest::Approx(1));
}

TEST_CASE("about another point they scatter by the square of its distance more") {
  const std::vector<Vec3> list = {{0, 0, 1}, {0, 0, -1}};
  const Eigen3<double> scatter = scatter_about(list, {3, 0, 0});
  CHECK(scatter.value[0] == doctest::Approx(9));
  CHECK(scatter.value[1] == doctest::Approx(1));
  CHECK(scatter.value[2] == doctest::Approx(0));
}
