// fit_points: derivatives, exact cases, many random elements, and the points that it must refuse.
#include <doctest/doctest.h>

#include "engine/features/descend.hpp"
#include "engine/features/solve.hpp"
#include "tests/unit/features/shapes.hpp"

using namespace abbe;

namespace {

FitProblem problem_on(const Element& e, Shape shape, int points, double noise, const Part& part = {}) {
  FitProblem problem{shape, {}, {}};
  for (int i = 0; i < points; ++i)
    problem.points.push_back(
        surface_point(e, shape, random_at("u", i), random_at("v", i), noise * (2 * random_at("noise", i) - 1), part));
  return problem;
}

std::string code_of(const FitProblem& problem) {
  const FitSolution solution = fit_points(problem);
  return solution.error ? solution.error->code : "";
}

template <class Profile>
void check_derivatives() {
  constexpr int N = kUnknowns<Profile>;
  using J = Jet<double, N>;
  const double size[2] = {Profile::kShape == Shape::torus ? 9.0 : 5.0, 0.6};
  for (int n = 0; n < 20; ++n) {
    const double q[3] = {between("x", n, -20, 20), between("y", n, -20, 20), between("z", n, -20, 20)};
    double ready[3] = {}, row[N + 1];
    Profile::prepare(size, ready);
    distance_row<Profile>(q[0], q[1], q[2], ready, row);
    J zero[N];
    for (int i = 0; i < N; ++i) zero[i] = J::unknown(0, i);
    const J d = displaced_distance<Profile>(q, zero, size);
    CHECK(row[N] == doctest::Approx(d.value).epsilon(1e-12));
    for (int i = 0; i < N; ++i) CHECK(row[i] == doctest::Approx(d.gradient[i]).epsilon(1e-12));
  }
}

template <class Profile>
void check_second_derivatives() {
  Placed<double> s;
  s.p[0] = 3, s.p[1] = -2, s.p[2] = 1, s.size[0] = 5;
  Points<double> points;
  for (int n = 0; n < 20; ++n)
    points.push_back({between("x", n, -20, 20), between("y", n, -20, 20), between("z", n, -20, 20)});
  const auto jets = newton_equations_by_jets<Profile>(points, s), ball = newton_equations_of_ball<Profile>(points, s);
  for (int i = 0; i < kUnknowns<Profile>; ++i) {
    CHECK(ball.b[i] == doctest::Approx(jets.b[i]).epsilon(1e-12));
    for (int j = 0; j <= i; ++j) CHECK(ball.a[i][j] == doctest::Approx(jets.a[i][j]).epsilon(1e-12));
  }
}

}  // namespace

TEST_CASE("second derivatives of a circle and a sphere equal those of the definition") {
  check_second_derivatives<CircleProfile>();
  check_second_derivatives<SphereProfile>();
}

TEST_CASE("derivatives written by hand equal those of the definition") {
  check_derivatives<CircleProfile>();
  check_derivatives<CylinderProfile>();
  check_derivatives<SphereProfile>();
  check_derivatives<ConeProfile>();
  check_derivatives<TorusProfile>();
}

TEST_CASE("points without errors give the element itself") {
  for (const FeatureKind* kind : feature_kinds()) {
    if (kind->shape == Shape::point || !is_basic(*kind)) continue;
    CAPTURE(kind->word);
    const Element truth = some_element(kind->shape);
    const FitSolution s = fit_points(problem_on(truth, kind->shape, 60, 0));
    REQUIRE_FALSE(s.error);
    CHECK(s.form < 1e-12);
    const double along = dot(s.element.point - truth.point, truth.direction);
    CHECK(s.element.size == doctest::Approx(truth.size + along * std::tan(truth.angle)).epsilon(1e-13));
    CHECK(s.element.minor_size == doctest::Approx(truth.minor_size).epsilon(1e-13));
    CHECK(norm(cross(s.element.point - truth.point, truth.direction)) < (kind->shape == Shape::plane ? 50 : 1e-11));
    if (kind->shape != Shape::sphere) CHECK(norm(cross(s.element.direction, truth.direction)) < 1e-13);
  }
}

TEST_CASE("the apex and the ends of a cone") {
  const Element truth = some_element(Shape::cone);
  const FitSolution s = fit_points(problem_on(truth, Shape::cone, 60, 0));
  REQUIRE_FALSE(s.error);
  CHECK(norm(s.apex - (truth.point - truth.size / std::tan(truth.angle) * truth.direction)) < 1e-11);
  CHECK(s.element.angle == doctest::Approx(truth.angle).epsilon(1e-14));
  CHECK(dot(s.element.direction, truth.direction) > 0);
  CHECK(s.element.begin < 0);
  CHECK(s.element.end > 0);
  CHECK(s.element.end - s.element.begin < 30);
}

TEST_CASE("no start is better than the truth") {
  for (const Shape shape : {Shape::circle, Shape::sphere, Shape::cylinder, Shape::cone, Shape::torus}) {
    for (int n = 0; n < 25; ++n) {
      Element e = some_element(shape);
      const double away = std::pow(10, between("away", n, 0, 5));
      e.point = {away, -away * random_at("p", n), away * random_at("q", n)};
      e.direction = unit(Vec3{between("i", n, -1, 1), between("j", n, -1, 1), between("k", n, -1, 1)});
      Part part;
      part.turn = between("turn", n, 30, 360) * kPi / 180;
      part.length = e.size * std::pow(10, between("length", n, -1, 1));
      if (shape == Shape::cone) {
        e.angle = between("angle", n, 1, 80) * kPi / 180;
        part.length = std::min(part.length, 1.9 * e.size / std::tan(e.angle));
      }
      if (shape == Shape::torus) e.minor_size = e.size * between("minor", n, 0.05, 0.9);
      const FitProblem problem = problem_on(e, shape, 40, e.size * std::pow(10, between("rough", n, -7, -3)), part);
      const FitSolution global = fit_points(problem), local = fit_points_from(problem, e);
      CAPTURE(feature_kind(shape).word);
      CAPTURE(n);
      REQUIRE_FALSE(local.error);
      REQUIRE_FALSE(global.error);
      CHECK(global.rms <= local.rms * (1 + 1e-9));
    }
  }
}

TEST_CASE("ten thousand points, in any order") {
  for (const Shape shape : {Shape::plane, Shape::cylinder, Shape::torus}) {
    FitProblem problem = problem_on(some_element(shape), shape, 10000, 0.02);
    const FitSolution s = fit_points(problem);
    REQUIRE_FALSE(s.error);
    CHECK(s.rms == doctest::Approx(0.02 / std::sqrt(3.0)).epsilon(0.03));
    std::reverse(problem.points.begin(), problem.points.end());
    const FitSolution reversed = fit_points(problem);
    REQUIRE_FALSE(reversed.error);
    CHECK(norm(s.element.point - reversed.element.point) < 1e-10);
    CHECK(norm(s.element.direction - reversed.element.direction) < 1e-12);
    CHECK(std::fabs(s.element.size - reversed.element.size) < 1e-10);
  }
}

TEST_CASE("the length of a prescribed normal means nothing") {
  FitProblem problem = problem_on(some_element(Shape::circle), Shape::circle, 20, 1e-3);
  for (const double length : {1.0, 1e-300, 1e300}) {
    problem.normal = Vec3{0.6 * length, 0, 0.8 * length};
    const FitSolution s = fit_points(problem);
    REQUIRE_FALSE(s.error);
    CHECK(norm(s.element.direction - Vec3{0.6, 0, 0.8}) < 1e-15);
  }
}

TEST_CASE("points that determine no element are refused with a reason") {
  const FitProblem on_plane = problem_on(some_element(Shape::plane), Shape::plane, 30, 0);
  const FitProblem on_line = problem_on(some_element(Shape::line), Shape::line, 30, 0);
  for (const Shape shape : {Shape::sphere, Shape::cylinder, Shape::cone, Shape::torus}) {
    CHECK(code_of({shape, on_plane.points, {}}) == "coplanar_points");
    CHECK(code_of({shape, on_line.points, {}}) == "collinear_points");
  }
  CHECK(code_of({Shape::circle, on_line.points, {}}) == "collinear_points");
  CHECK(code_of({Shape::circle, on_plane.points, Vec3{}}) == "bad_normal");
  CHECK(code_of({Shape::circle, on_plane.points, Vec3{NAN, 0, 1}}) == "bad_normal");
  CHECK(code_of({Shape::circle, on_plane.points, any_perpendicular(some_element(Shape::plane).direction)}) ==
        "collinear_points");
  CHECK(code_of({Shape::line, {{1, 2, 3}, {1, 2, 3}}, {}}) == "identical_points");
  CHECK(code_of({Shape::plane, {{1, 2, 3}, {4, 5, 7}, {4, 5, 7}, {1, 2, 3}}, {}}) == "too_few_points");
  CHECK(code_of({Shape::sphere, {}, {}}) == "too_few_points");
  CHECK(code_of({Shape::line, {{1, 2, 3}, {INFINITY, 2, 3}}, {}}) == "not_finite");
}

TEST_CASE("an answer that is one of several is no answer") {
  std::vector<Vec3> cube;
  for (const double x : {-1, 1})
    for (const double y : {-1, 1})
      for (const double z : {-1, 1}) cube.push_back({10 * x, 10 * y, 10 * z});
  for (const Shape shape : {Shape::line, Shape::plane, Shape::circle, Shape::cylinder})
    CHECK(code_of({shape, cube, {}}) == "not_unique");
  CHECK(code_of({Shape::sphere, cube, {}}) == "");
  CHECK(code_of({Shape::cone, problem_on(some_element(Shape::cylinder), Shape::cylinder, 40, 0).points, {}}) ==
        "no_apex");
}

namespace {

/// The n-th large surface, with any direction; it passes through the origin.
Element large(double radius, int n) {
  const Vec3 axis = unit(Vec3{between("i", n, -1, 1), between("j", n, -1, 1), between("k", n, -1, 1)});
  return {.point = -radius * cross(axis, any_perpendicular(axis)), .direction = axis, .size = radius};
}

/// A patch of it at the origin: `width` mm along the arc and across it.
FitProblem shallow(Shape shape, double radius, double width, int n, int points, double noise) {
  const Vec3 x = large(radius, n).direction, y = any_perpendicular(x), z = cross(x, y);
  FitProblem problem{shape, {}, {}};
  for (int i = 0; i < points; ++i) {
    const double along = between("along", 1000 * n + i, -0.5, 0.5) * width,
                 across = between("across", 1000 * n + i, -0.5, 0.5) * width;
    const double angle = along / radius, tilt = shape == Shape::sphere ? across / radius : 0;
    const double height = shape == Shape::cylinder ? across : radius * std::sin(tilt);
    const double out = radius * std::cos(tilt) + noise * (2 * random_at("rough", 1000 * n + i) - 1);
    problem.points.push_back(height * x + out * (std::sin(angle) * y + std::cos(angle) * z) - radius * z);
  }
  return problem;
}

/// A wavy plane, the same from both sides.
FitProblem wave(Shape shape) {
  FitProblem problem{shape, {}, {}};
  for (int i = -3; i <= 3; ++i)
    for (int j = -3; j <= 3; ++j)
      problem.points.push_back({3.0 * i, 3.0 * j, 0.05 * std::sin(3.0 * i) + 0.03 * std::sin(2.0 * j)});
  return problem;
}

double plane_rms(const FitProblem& problem) { return fit_points({Shape::plane, problem.points, {}}).rms; }

/// A start somewhere near the points, of any direction and size.
Element random_start(const FitProblem& problem, int n) {
  const FitSolution ball = fit_points({Shape::point, problem.points, {}});
  double extent = 0;
  for (const Vec3& p : problem.points) extent = std::max(extent, norm(p - ball.element.point));
  const Vec3 axis = unit(Vec3{between("axis x", n, -1, 1), between("axis y", n, -1, 1), between("axis z", n, -1, 1)});
  const double size = extent * std::pow(10, between("size", n, -0.5, 1)), turn = between("turn", n, 0, 2 * kPi);
  const Vec3 x = any_perpendicular(axis), away = std::cos(turn) * x + std::sin(turn) * cross(axis, x);
  return {.point = ball.element.point + size * away,
          .direction = axis,
          .size = size,
          .minor_size = extent * std::pow(10, between("tube", n, -1, 0.3))};
}

}  // namespace

TEST_CASE("short arcs without errors give the element itself") {
  for (const Shape shape : {Shape::circle, Shape::sphere, Shape::cylinder})
    for (const double radius : {1000.0, 5000.0})
      for (const double width : {0.04, 0.02, 0.01, 0.003})
        for (int n = 0; n < 5; ++n) {
          CAPTURE(feature_kind(shape).word);
          CAPTURE(radius);
          CAPTURE(width);
          const FitSolution s = fit_points(shallow(shape, radius, width * radius, n, 25, 0));
          REQUIRE_FALSE(s.error);
          // Coordinates are rounded to 1e-16 of the radius; the radius shows in them as the height of the arc.
          CHECK(std::fabs(s.element.size - radius) < 1e-15 * radius / (width * width / 8));
        }
}

TEST_CASE("no start is better than the truth on shallow, rough patches") {
  for (const Shape shape : {Shape::circle, Shape::sphere, Shape::cylinder})
    for (const double noise : {1e-3, 1e-2, 5e-2})
      for (int n = 0; n < 10; ++n) {
        const FitProblem problem = shallow(shape, 1000, 20, n, 25, noise);
        CAPTURE(feature_kind(shape).word);
        CAPTURE(noise);
        CAPTURE(n);
        const FitSolution global = fit_points(problem), local = fit_points_from(problem, large(1000, n));
        REQUIRE_FALSE(global.error);
        REQUIRE_FALSE(local.error);
        CHECK(global.rms <= local.rms * (1 + 1e-9));
        CHECK(global.rms < 1.2 * noise / std::sqrt(3.0));
      }
}

TEST_CASE("points whose best element is infinitely large are refused") {
  for (const Shape shape : {Shape::sphere, Shape::cylinder, Shape::cone})
    CHECK(code_of(wave(shape)) == "not_converged");
  FitProblem line{Shape::circle, {}, {}};
  for (int i = -5; i <= 5; ++i) line.points.push_back({1.0 * i, 0.1 * std::sin(1.0 * i), 0});
  CHECK(code_of(line) == "not_converged");
  const FitProblem tube = problem_on(some_element(Shape::cylinder), Shape::cylinder, 60, 0);
  CHECK(code_of({Shape::torus, tube.points, {}}) == "not_converged");
}

TEST_CASE("rough planes have a best ball and a best cylinder, large ones") {
  const FitProblem rough = problem_on(some_element(Shape::plane), Shape::plane, 40, 1e-3);
  for (const Shape shape : {Shape::sphere, Shape::cylinder}) {
    const FitSolution s = fit_points({shape, rough.points, {}});
    REQUIRE_FALSE(s.error);
    CHECK(s.rms < plane_rms(rough));
    CHECK(s.element.size > 1e4);
  }
}

TEST_CASE("no start is better on rough parts of tori") {
  for (int n = 0; n < 6; ++n) {
    Element e = some_element(Shape::torus);
    e.minor_size = e.size * between("minor", n, 0.3, 0.6);
    const FitProblem problem = problem_on(e, Shape::torus, 16 + 4 * n, 0.1 * e.size, {.turn = 1.5, .tube = 3});
    const FitSolution global = fit_points(problem);
    REQUIRE_FALSE(global.error);
    for (int k = 0; k < 150; ++k) {
      CAPTURE(n);
      CAPTURE(k);
      const FitSolution local = fit_points_from(problem, random_start(problem, 1000 * n + k));
      if (!local.error) CHECK(global.rms <= local.rms * (1 + 1e-9));
    }
  }
}

TEST_CASE("short sectors of large tori") {
  for (const double radius : {300.0, 1000.0, 3000.0, 10000.0})
    for (const double noise : {0.0, 1e-3}) {
      Element e = some_element(Shape::torus);
      e.size = radius, e.minor_size = 20;
      const FitProblem problem = problem_on(e, Shape::torus, 60, noise, {.turn = 40 / radius});
      CAPTURE(radius);
      CAPTURE(noise);
      const FitSolution s = fit_points(problem), local = fit_points_from(problem, e);
      REQUIRE_FALSE(s.error);
      REQUIRE_FALSE(local.error);
      CHECK(s.rms <= local.rms * (1 + 1e-9) + 1e-15 * radius);
      CHECK(std::fabs(s.element.size / radius - 1) < (noise > 0 ? 1e-5 * radius : 1e-6));
    }
}

TEST_CASE("a rough straight tube has a best torus, a large one") {
  const FitProblem tube = problem_on(some_element(Shape::cylinder), Shape::cylinder, 60, 1e-2);
  const FitSolution straight = fit_points(tube), bent = fit_points({Shape::torus, tube.points, {}});
  REQUIRE_FALSE(straight.error);
  REQUIRE_FALSE(bent.error);
  CHECK(bent.rms < straight.rms);
  CHECK(bent.element.size > 1000);
  CHECK(bent.element.minor_size == doctest::Approx(straight.element.size).epsilon(1e-3));
}
