// The measured extent that orientation tolerances need (element.hpp: begin, end), from both fits.
#include <doctest/doctest.h>

#include "engine/features/feature.hpp"
#include "engine/features/fit.hpp"

using namespace abbe;

TEST_CASE("The extent of a plane is how far its touches lie from their centroid") {
  const std::vector<Vec3> corners = {{0, 0, 7}, {60, 0, 7}, {60, 80, 7}, {0, 80, 7}, {30, 40, 7}};
  const FitSolution solution = fit_points({.shape = Shape::plane, .points = corners, .normal = {}});
  REQUIRE_FALSE(solution.error);
  CHECK(solution.element.end == doctest::Approx(50));
  CHECK(solution.element.begin == doctest::Approx(-50));
  CHECK(solution.element.high == doctest::Approx(0).scale(1));

  std::vector<double> columns;
  for (const Vec3& p : corners)
    for (int k = 0; k < 3; ++k) columns.push_back(p[k]);
  const Element start{.point = {0, 0, 7}, .direction = {0, 0, 1}};
  Element fitted;
  const char* failure = nullptr;
  feature_kind(Shape::plane).fit_lanes({columns.data(), 5, 1, 1}, &start, &fitted, &failure);
  REQUIRE(failure == nullptr);
  CHECK(fitted.end == doctest::Approx(50));
  CHECK(fitted.begin == doctest::Approx(-50));
}
