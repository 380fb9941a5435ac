// The fits over lanes: independent of how lanes are put into batches, and equal to the fits of single lanes.
#include <doctest/doctest.h>

#include <vector>

#include "engine/features/feature.hpp"
#include "engine/features/fit.hpp"
#include "tests/unit/features/shapes.hpp"

using namespace abbe;

TEST_CASE("every lane of a batch has the fit of its own points") {
  for (const FeatureKind* kind : feature_kinds()) {
    if (kind->shape == Shape::point || !is_basic(*kind)) continue;
    CAPTURE(kind->word);
    const Element start = some_element(kind->shape);
    const Batch batch = some_batch(start, kind->shape, 25, 40, 2e-3);
    const BatchFit fitted = fit_batch(*kind, batch, start);
    for (int l = 0; l < batch.lanes; ++l) {
      REQUIRE(fitted.failure[l] == nullptr);
      FitProblem problem{kind->shape, batch.lane(l), {}};
      if (kind->shape == Shape::circle) problem.normal = start.direction;
      const FitSolution alone = fit_points(problem);
      REQUIRE_FALSE(alone.error);
      const Element &a = fitted.element[l], &b = alone.element;
      CHECK(norm(a.point - b.point) < 1e-9);
      if (kind->shape != Shape::sphere) CHECK(norm(cross(a.direction, b.direction)) < 1e-10);
      CHECK(dot(a.direction, start.direction) > 0);
      CHECK(a.size == doctest::Approx(b.size).epsilon(1e-11));
      CHECK(a.minor_size == doctest::Approx(b.minor_size).epsilon(1e-11));
      CHECK(a.angle == doctest::Approx(b.angle).epsilon(1e-11));
      CHECK(a.high - a.low == doctest::Approx(alone.form).epsilon(1e-6));
      CHECK(a.end - a.begin == doctest::Approx(b.end - b.begin).epsilon(1e-10));
    }
  }
}

TEST_CASE("the result of a lane does not depend on its batch") {
  constexpr int lanes = 128;
  for (const FeatureKind* kind : feature_kinds()) {
    if (!is_basic(*kind)) continue;
    CAPTURE(kind->word);
    const Element start = some_element(kind->shape);
    const Batch batch = some_batch(start, kind->shape, 12, lanes, 5e-3);
    const BatchFit whole = fit_batch(*kind, batch, start);
    for (const int size : {1, 7}) {
      for (int first = 0; first < lanes; first += size) {
        const Batch part = batch.part(first, std::min(size, lanes - first));
        const BatchFit fitted = fit_batch(*kind, part, start);
        for (int l = 0; l < part.lanes; ++l) CHECK(same_bits(fitted.element[l], whole.element[first + l]));
      }
    }
  }
}

TEST_CASE("a lane that Gauss-Newton cannot settle from the start is fitted all the same") {
  const FeatureKind& kind = feature_kind(Shape::sphere);
  const Element truth = some_element(Shape::sphere);
  Element start = truth;
  start.point += Vec3{400, -300, 200};  // far outside: the first step is larger than the feature
  start.size = 1;
  const Batch batch = some_batch(truth, Shape::sphere, 25, 3, 1e-3);
  const BatchFit fitted = fit_batch(kind, batch, start);
  for (int l = 0; l < batch.lanes; ++l) {
    REQUIRE(fitted.failure[l] == nullptr);
    CHECK(norm(fitted.element[l].point - truth.point) < 0.01);
  }
}

TEST_CASE("short arcs over lanes: each lane its own minimum, and the spread that the linearised model gives") {
  const Element truth{.point = {120, -80, 45}, .direction = unit(Vec3{0.3, -0.5, 0.8}), .size = 1000};
  const Vec3 x = any_perpendicular(truth.direction), y = cross(truth.direction, x);
  constexpr int lanes = 400, points = 7;
  constexpr double noise = 1e-3;  // mm, largest
  for (const double arc : {1.0, 2.0, 4.0}) {
    CAPTURE(arc);
    Batch batch{points, lanes, std::vector<double>(3 * points * lanes)};
    double s2 = 0, s4 = 0;  // sums of v^2 and v^4: d = ... + (1 - cos v) dR, about its mean
    for (int t = 0; t < points; ++t) {
      const double v = arc * kPi / 180 * (t / 6.0 - 0.5), height = 1 - std::cos(v);
      s2 += height, s4 += height * height;
      for (int l = 0; l < lanes; ++l) {
        const double out = truth.size + noise * (2 * random_at("short arc", t * lanes + l) - 1);
        const Vec3 p = truth.point + out * (std::cos(v) * x + std::sin(v) * y);
        for (int k = 0; k < 3; ++k) batch.set(t, k, l, p[k]);
      }
    }
    const FeatureKind& kind = feature_kind(Shape::circle);
    const BatchFit fitted = fit_batch(kind, batch, truth);
    const double expected = noise / std::sqrt(3.0) / std::sqrt(s4 - s2 * s2 / points);
    double sum = 0, squares = 0;
    for (int l = 0; l < lanes; ++l) {
      REQUIRE(fitted.failure[l] == nullptr);
      const double off = fitted.element[l].size - truth.size;
      sum += off, squares += off * off;
      const FitSolution alone = fit_points({Shape::circle, batch.lane(l), truth.direction});
      REQUIRE_FALSE(alone.error);
      CHECK(std::fabs(fitted.element[l].size - alone.element.size) < 1e-8 * expected);
      const BatchFit single = fit_batch(kind, batch.part(l, 1), truth);
      CHECK(same_bits(single.element[0], fitted.element[l]));
    }
    CHECK(std::sqrt((squares - sum * sum / lanes) / (lanes - 1)) == doctest::Approx(expected).epsilon(0.1));
  }
}

TEST_CASE("a lane without a solution says why and does not disturb its neighbours") {
  const FeatureKind& kind = feature_kind(Shape::cylinder);
  const Element truth = some_element(Shape::cylinder);
  Batch batch = some_batch(truth, Shape::cylinder, 20, 3, 1e-3);
  const BatchFit before = fit_batch(kind, batch, truth);
  for (int t = 0; t < batch.points; ++t)
    for (int k = 0; k < 3; ++k) batch.set(t, k, 1, 5.0);
  const BatchFit after = fit_batch(kind, batch, truth);
  REQUIRE(after.failure[1] != nullptr);
  CHECK(std::string(after.failure[1]).find("identical") != std::string::npos);
  CHECK(same_bits(before.element[0], after.element[0]));
  CHECK(same_bits(before.element[2], after.element[2]));
}

TEST_CASE("planes and lines refuse points that do not determine them") {
  for (const Shape shape : {Shape::line, Shape::plane}) {
    const FeatureKind& kind = feature_kind(shape);
    Batch batch = some_batch(some_element(shape), shape, 6, 1, 0);
    for (int t = 0; t < batch.points; ++t)
      for (int k = 0; k < 3; ++k) batch.set(t, k, 0, shape == Shape::line ? 1.0 : 1.0 + t * (k + 1));
    CHECK(fit_batch(kind, batch, some_element(shape)).failure[0] != nullptr);
    batch.set(0, 1, 0, NAN);
    CHECK(fit_batch(kind, batch, some_element(shape)).failure[0] != nullptr);
  }
}
