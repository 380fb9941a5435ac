// fit_touched: which of the elements through a few points is meant.
#include "engine/features/touched_fit.hpp"

#include <doctest/doctest.h>

#include "tests/unit/features/shapes.hpp"

using namespace abbe;

namespace {

/// Touches of a bore or a cone along z, in sections, as a program with `decimals` writes them.
struct Touches {
  std::vector<Vec3> points, normals;
};
Touches touches_of(Shape shape, const Element& e, double turn, int sections, int in_section, double step,
                   double written_mm) {
  const auto written = [&](double v) { return written_mm > 0 ? written_mm * std::round(v / written_mm) : v; };
  Touches t;
  for (int k = 0; k < sections; ++k)
    for (int i = 0; i < in_section; ++i) {
      const double a = turn + 2 * kPi * i / in_section;
      const double rise = shape == Shape::cone ? std::tan(e.angle) : 0;
      const Vec3 out{std::cos(a), std::sin(a), 0},
          p = e.point + (e.size - k * step * rise) * out - Vec3{0, 0, k * step};
      t.points.push_back({written(p.x), written(p.y), written(p.z)});
      t.normals.push_back(unit(-1 * out + Vec3{0, 0, rise}));
    }
  return t;
}

}  // namespace

TEST_CASE("few touches of a bore are of the bore, however they are written and wherever its nominal is") {
  for (int n = 0; n < 300; ++n) {
    CAPTURE(n);
    Element bore{
        .point = {between("bore x", n, -300, 300), between("bore y", n, -300, 300), between("bore z", n, -50, 0)},
        .direction = {0, 0, 1},
        .size = between("bore size", n, 3, 20)};
    const double written[] = {1e-3, 1e-4, 1e-6, 0};
    const Touches t = touches_of(Shape::cylinder, bore, between("bore turn", n, 0, 2 * kPi), 2, 3 + n % 4,
                                 between("bore step", n, 3, 20), written[n / 4 % 4]);
    Element dummy = bore;
    if (n % 3 > 0) dummy.point = {};
    if (n % 3 > 1) dummy.direction = {1, 0, 0};
    const FitSolution solution = fit_touched(Shape::cylinder, t.points, t.normals, dummy);
    REQUIRE_FALSE(solution.error);
    CHECK(solution.element.size == doctest::Approx(bore.size).epsilon(1e-3));
    CHECK(std::fabs(solution.element.direction.z) > 0.999);
  }
}

TEST_CASE("few touches of a cone are of the cone") {
  for (int n = 0; n < 100; ++n) {
    CAPTURE(n);
    Element cone{.point = {between("cone x", n, -300, 300), between("cone y", n, -300, 300), 0},
                 .direction = {0, 0, 1},
                 .size = between("cone size", n, 10, 20),
                 .angle = between("cone angle", n, 10, 40) * kPi / 180};
    const Touches t = touches_of(Shape::cone, cone, between("cone turn", n, 0, 2 * kPi), 2, 4 + n % 3, 8, 0);
    Element dummy = cone;
    dummy.point = {};
    const FitSolution solution = fit_touched(Shape::cone, t.points, t.normals, dummy);
    REQUIRE_FALSE(solution.error);
    CHECK(solution.element.angle == doctest::Approx(cone.angle).epsilon(1e-3));
  }
}

TEST_CASE("vectors that are wrong do not move the element next to the nominal") {
  const Element bore{.point = {40, 30, 0}, .direction = {0, 0, 1}, .size = 8};
  Touches t = touches_of(Shape::cylinder, bore, 0.3, 2, 6, 10, 0);
  for (Vec3& n : t.normals) n = {0, 0, 1};
  const FitSolution solution = fit_touched(Shape::cylinder, t.points, t.normals, bore);
  REQUIRE_FALSE(solution.error);
  CHECK(solution.element.size == doctest::Approx(8).epsilon(1e-6));
}
