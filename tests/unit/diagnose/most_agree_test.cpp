#include "engine/diagnose/checks/most_agree.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace abbe;
using namespace abbe::diagnose;

namespace {

/// Turned by a quarter about z, and shifted.
Vec3 turned_and_shifted(const Vec3& v) { return Vec3{-v.y, v.x, v.z} + Vec3{120, -35, 8}; }

std::vector<Vec3> grid() {
  std::vector<Vec3> out;
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 4; ++y) out.push_back({100.0 * x, 80.0 * y, 15.0 * x * y});
  return out;
}

}  // namespace

TEST_CASE("a placement is the one of most points, wherever a few others lie") {
  const std::vector<Vec3> here = grid();
  std::vector<Vec3> there;
  for (const Vec3& v : here) there.push_back(turned_and_shifted(v));
  there[2] = 1000.0 * there[2];  // a row in micrometres
  there[7].z += 40;
  const auto found = placement_of_most(here, there);
  REQUIRE(found);
  for (const Vec3& v : here) CHECK(norm(*found * v - turned_and_shifted(v)) < 1e-9);
}

TEST_CASE("deviations below a millimetre all count") {
  const std::vector<Vec3> here = grid();
  std::vector<Vec3> there = here;
  there[0].x += 0.6;  // the others agree to the last digit, and the middle of their distances is nothing
  const auto found = placement_of_most(here, there);
  REQUIRE(found);
  double square = 0, without = 0;
  for (std::size_t i = 0; i < here.size(); ++i)
    square += std::pow(norm(*found * here[i] - there[i]), 2), without += std::pow(norm(here[i] - there[i]), 2);
  CHECK(norm(*found * here[5] - here[5]) > 0.01);  // it takes its part of the one that is off
  CHECK(square < without);
}

TEST_CASE("points on a line, or too few of them, leave a placement open") {
  CHECK(!placement_of_most({{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {1, 0, 0}}));
  const std::vector<Vec3> line{{0, 0, 0}, {10, 10, 0}, {20, 20, 0}, {35, 35, 0}};
  CHECK(!placement_of_most(line, line));
}
