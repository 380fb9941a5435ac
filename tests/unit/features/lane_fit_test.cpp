// The fits over lanes: independent of how lanes are put into batches, and equal to the fits of single lanes.
#include <doctest/doctest.h>

#include <chrono>
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
