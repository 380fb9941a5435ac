#include "engine/math/rigid_fit.hpp"

#include <doctest/doctest.h>

using namespace abbe;

TEST_CASE("a rigid transform is found again") {
  const Rigid X{rotation(unit(Vec3{1, 2, -1}), 2.1), {10, -20, 300}};
  const std::vector<Vec3> here{{0, 0, 0}, {100, 0, 5}, {0, 80, -7}, {30, 40, 60}};
  std::vector<Vec3> there;
  for (const Vec3& p : here) there.push_back(X * p);
  const auto found = rigid_fit(here, there);
  REQUIRE(found.has_value());
  for (const Vec3& p : here) CHECK(norm(*found * p - X * p) < 1e-9);
}

TEST_CASE("points of one plane settle a transform") {
  const Rigid X{rotation(unit(Vec3{1, 2, -1}), 2.1), {10, -20, 300}};
  const std::vector<Vec3> here{{0, 0, 5}, {100, 0, 5}, {0, 80, 5}};
  std::vector<Vec3> there;
  for (const Vec3& p : here) there.push_back(X * p);
  const auto found = rigid_fit(here, there);
  REQUIRE(found.has_value());
  CHECK(norm(*found * Vec3{7, 8, 90} - X * Vec3{7, 8, 90}) < 1e-9);
}

TEST_CASE("points on one line, or too few, settle no transform") {
  const std::vector<Vec3> line{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {5, 5, 5}}, two{{0, 0, 0}, {1, 0, 0}};
  CHECK_FALSE(rigid_fit(line, line).has_value());
  CHECK_FALSE(rigid_fit(two, two).has_value());
}
