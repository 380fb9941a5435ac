// fit_points on few points: they have many minima, and along a long thin element these lie close together. None may be
// better than the one that is found.
#include <doctest/doctest.h>

#include "engine/features/solve.hpp"
#include "tests/unit/features/shapes.hpp"

using namespace abbe;

namespace {

/// Between the limits, as often within 2 to 4 as within 20 to 40.
double between_by_ratio(std::string_view stream, int n, double low, double high) {
  return low * std::pow(high / low, random_at(stream, n));
}

/// The n-th element, of any direction.
Element few_points_element(Shape shape, int n, double length) {
  Element e{.point = {100, 100, 100}, .size = between_by_ratio("few size", n, 2, 50)};
  e.direction = unit(Vec3{between("few i", n, -1, 1), between("few j", n, -1, 1), between("few k", n, -1, 1)});
  if (shape != Shape::cone) return e;
  e.angle = between("few angle", n, 2, 70) * kPi / 180;
  e.size = length * std::tan(e.angle) * between("few cut", n, 0.5, 1.5);  // the apex is at 0.5
  return e;
}

/// At least as many points on it as have one best element, mostly not many more, and at most twelve.
FitProblem few_points(const Element& e, Shape shape, int n, double length) {
  const Part part{.turn = between("few turn", n, 0.5, 2 * kPi), .length = length};
  const double noise = between_by_ratio("few noise", n, 0.002, 0.02);
  const int least = feature_kind(shape).minimum_points + 1;
  const int points = least + static_cast<int>((13 - least) * std::pow(random_at("few points", n), 3));
  FitProblem problem{shape, {}, {}};
  for (int i = 0; i < points; ++i) {
    const int at = 100 * n + i;
    const double out = noise * between("few out", at, -1, 1);
    problem.points.push_back(surface_point(e, shape, random_at("few u", at), random_at("few v", at), out, part));
  }
  return problem;
}

}  // namespace

TEST_CASE("long thin cylinders through a few points") {
  const FitSolution seven = fit_points({Shape::cylinder,
                                        {{417.88, -33.51, 164.76},
                                         {170.22, 82.89, 117.07},
                                         {513.90, -56.97, 192.74},
                                         {422.09, -35.03, 163.98},
                                         {479.41, -42.12, 185.18},
                                         {304.14, 30.74, 135.82},
                                         {174.54, 81.92, 114.70}},
                                        {}});
  REQUIRE_FALSE(seven.error);
  CHECK(seven.rms < 0.0035);  // that of the cylinder they were taken from
  CHECK(norm(cross(seven.element.direction, {0.916869, -0.354156, 0.184188})) < 1e-3);
  const FitSolution six = fit_points({Shape::cylinder,
                                      {{-330.0048370636832, 213.58671470230016, 36.52023385335207},
                                       {-11.114237252930263, 119.43900489236694, 75.8930858242416},
                                       {-145.26463074772866, 160.86353179452976, 51.3508742751291},
                                       {-159.61049252131323, 153.56160842164277, 63.467534347497406},
                                       {-103.15522441620601, 142.740306323398, 76.08313724169558},
                                       {4.515539219035455, 116.79785078384582, 93.10943564442039}},
                                      {}});
  REQUIRE_FALSE(six.error);
  CHECK(six.rms < 0.016);
}

TEST_CASE("no start is better than the truth through a few points") {
  for (const Shape shape : {Shape::cylinder, Shape::cone})
    for (int n = 0; n < 500; ++n) {
      const double length = between_by_ratio("few length", n, 20, 500);
      const Element truth = few_points_element(shape, n, length);
      const FitProblem problem = few_points(truth, shape, n, length);
      const FitSolution global = fit_points(problem), local = fit_points_from(problem, truth);
      CAPTURE(feature_kind(shape).word);
      CAPTURE(n);
      if (local.error) continue;  // some few points have no best element near the true one
      REQUIRE_FALSE(global.error);
      CHECK(global.rms <= local.rms * (1 + 1e-9) + 1e-9);
    }
}

// Far away from its axis the distances of all points are one number but for their last digit.
TEST_CASE("no cylinder is larger than its points can tell") {
  const std::vector<std::array<double, 2>> section{
      {720.1, 295.4}, {717.336, 299.204}, {712.864, 297.751}, {712.864, 293.049}, {717.336, 291.596}};
  std::vector<Vec3> points;
  for (const double z : {-502.0, -507.0})
    for (const auto& p : section) points.push_back({p[0], p[1], z});
  const FitSolution solution = fit_points({Shape::cylinder, points, {}});
  REQUIRE_FALSE(solution.error);
  CHECK(solution.element.size == doctest::Approx(3.99985).epsilon(1e-5));
}
