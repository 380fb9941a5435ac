// Slots, rectangles, ellipses and pairs of planes: distances, fits of exact and of disturbed points,
// and the patterns by which machines touch them.
#include "engine/features/outline.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "engine/features/nominal_normal.hpp"
#include "engine/features/pattern.hpp"

using namespace abbe;
using doctest::Approx;

namespace {

Element outline(double length, double width, double flat = 0) {
  return {.point = {40, 30, -5},
          .direction = {0, 0, 1},
          .size = length,
          .minor_size = width,
          .second = {1, 0, 0},
          .angle = flat};
}

struct Fitted {
  Element element;
  std::string failure;
};

Fitted fit(Shape shape, const std::vector<Vec3>& points, const Element& start) {
  std::vector<double> data;
  for (const Vec3& p : points) data.insert(data.end(), {p.x, p.y, p.z});
  Fitted f;
  const char* failure = nullptr;
  feature_kind(shape).fit_lanes({data.data(), static_cast<int>(points.size()), 1, 1}, &start, &f.element, &failure);
  f.failure = failure ? failure : "";
  return f;
}

/// The touches of the default pattern of `e`.
std::vector<Vec3> touches(Shape shape, const Element& e, int count, bool inner = false) {
  std::vector<Vec3> points;
  for (int k = 0; k < count; ++k) {
    const auto touch = pattern_touch(feature_kind(shape), e, inner, k, count);
    REQUIRE(touch);
    points.push_back(touch.value.point);
  }
  return points;
}

Element displaced(Element e) {
  const Rigid X{rotation({0, 0, 1}, 0.004), {0.05, -0.03, 0.02}};
  const Vec3 centre = e.point;
  e = Rigid{X.R, {}} * e;
  e.point = centre + X.p;
  e.size *= 1.001, e.minor_size *= 0.998;
  return e;
}

}  // namespace

TEST_CASE("Distances from slots, rectangles and ellipses") {
  const auto slot = [](double u, double v) { return outline_distance(Shape::slot, false, u, v, 15, 5); };
  CHECK(slot(3, 6).d == Approx(1));
  CHECK(slot(3, -4).d == Approx(-1));
  CHECK(slot(-16, 0).d == Approx(1));
  CHECK(slot(13, 4).d == Approx(0));  // 3, 4, 5 about the centre of the end at 10
  CHECK(outline_distance(Shape::slot, true, 16, 4, 15, 5).d == Approx(1));
  CHECK(outline_distance(Shape::rectangle, false, 2, -7, 15, 5).d == Approx(2));
  const auto ellipse = [](double u, double v) { return outline_distance(Shape::ellipse, false, u, v, 5, 3); };
  CHECK(ellipse(7, 0).d == Approx(2));
  CHECK(ellipse(0, -4).d == Approx(1));
  CHECK(ellipse(0, 2).d == Approx(-1));
  // Two out of the ellipse along its normal at the parameter 0.7: the foot is found again.
  const double c = std::cos(0.7), s = std::sin(0.7), n = std::hypot(c / 5, s / 3);
  const OutlineDistance o = ellipse(5 * c + 2 * c / 5 / n, -3 * s - 2 * s / 3 / n);
  CHECK(o.d == Approx(2).epsilon(1e-12));
  CHECK(o.nu == Approx(c / 5 / n).epsilon(1e-12));
  CHECK(o.nv == Approx(-s / 3 / n).epsilon(1e-12));
}

TEST_CASE("The derivatives of the distance are its slopes") {
  const double h = 1e-6;
  for (const Shape shape : {Shape::slot, Shape::rectangle, Shape::ellipse})
    for (const auto& [u, v] : {std::pair{3.0, 6.0}, {13.5, 4.2}, {-14.9, 1.0}, {-2.0, -4.5}}) {
      const auto d = [&](double du, double dv, double dl, double dw) {
        return outline_distance(shape, false, u + du, v + dv, 15 + dl, 5 + dw).d;
      };
      const OutlineDistance o = outline_distance(shape, false, u, v, 15, 5);
      CAPTURE(static_cast<int>(shape));
      CHECK(o.nu == Approx((d(h, 0, 0, 0) - d(-h, 0, 0, 0)) / (2 * h)).epsilon(1e-6));
      CHECK(o.nv == Approx((d(0, h, 0, 0) - d(0, -h, 0, 0)) / (2 * h)).epsilon(1e-6));
      CHECK(o.length == Approx((d(0, 0, h, 0) - d(0, 0, -h, 0)) / (2 * h)).epsilon(1e-6));
      CHECK(o.width == Approx((d(0, 0, 0, h) - d(0, 0, 0, -h)) / (2 * h)).epsilon(1e-6));
    }
}

TEST_CASE("Outlines are found again from a start nearby") {
  for (const Shape shape : {Shape::slot, Shape::rectangle, Shape::ellipse}) {
    const Element truth = outline(15, 5);
    const Fitted f = fit(shape, touches(shape, truth, 12), displaced(truth));
    CAPTURE(static_cast<int>(shape));
    REQUIRE(f.failure == "");
    CHECK(norm(f.element.point - truth.point) < 1e-10);
    CHECK(norm(f.element.second - truth.second) < 1e-10);
    CHECK(f.element.size == Approx(15).epsilon(1e-12));
    CHECK(f.element.minor_size == Approx(5).epsilon(1e-12));
    CHECK(f.element.high - f.element.low < 1e-10);
  }
}

TEST_CASE("Residuals of an outline have no slope at the least-squares fit") {
  const Element truth = outline(25, 12);
  std::vector<Vec3> points = touches(Shape::ellipse, truth, 9);
  for (int k = 0; k < 9; ++k)
    points[static_cast<std::size_t>(k)] += Vec3{0.01 * std::cos(7.0 * k), 0.01 * std::sin(3.0 * k), 0};
  const Fitted f = fit(Shape::ellipse, points, truth);
  REQUIRE(f.failure == "");
  const auto cost = [&](Element e) {
    double sum = 0;
    for (const Vec3& p : points) {
      const Vec3 w = p - e.point;
      const double d = outline_distance(Shape::ellipse, false, dot(w, e.second), dot(w, cross(e.direction, e.second)),
                                        e.size, e.minor_size)
                           .d;
      sum += d * d;
    }
    return sum;
  };
  const double least = cost(f.element);
  for (const double step : {-1e-4, 1e-4}) {
    Element e = f.element;
    e.point.x += step;
    CHECK(cost(e) > least);
    e = f.element, e.size += step;
    CHECK(cost(e) > least);
    e = f.element, e.minor_size += step;
    CHECK(cost(e) > least);
    e = f.element, e.second = rotation({0, 0, 1}, step) * e.second;
    CHECK(cost(e) > least);
  }
}

TEST_CASE("A slot without touches on its ends keeps its length and place along itself") {
  const Element truth = outline(15, 5);
  const std::vector<Vec3> sides = {{32, 35.01, -5}, {48, 35.01, -5}, {31, 24.99, -5}, {40, 24.99, -5}, {49, 24.99, -5}};
  const Fitted f = fit(Shape::slot, sides, truth);
  REQUIRE(f.failure == "");
  CHECK(f.element.size == 15);
  CHECK(f.element.point.x == Approx(40));
  CHECK(f.element.minor_size == Approx(5.01));
  CHECK(fit(Shape::ellipse, std::vector<Vec3>(5, Vec3{1, 2, 3}), truth).failure != "");
}

TEST_CASE("Parallel planes have one normal, a width and a middle") {
  const Element start{.point = {0, 0, 0}, .direction = {0, 1, 0}, .size = 5};
  // Faces 10.02 apart, leaning by 1e-3, the middle 0.03 off.
  const Rigid lean{rotation({0, 0, 1}, 1e-3), {0, 0.03, 0}};
  std::vector<Vec3> points;
  for (const double side : {-5.01, 5.01})
    for (const auto& [x, z] : {std::pair{-20.0, 0.0}, {20.0, 0.0}, {0.0, 9.0}})
      points.push_back(lean * Vec3{x, side, z});
  const Fitted f = fit(Shape::parallel_planes, points, start);
  REQUIRE(f.failure == "");
  CHECK(2 * f.element.size == Approx(10.02).epsilon(1e-12));
  CHECK(norm(f.element.direction - lean.R * Vec3{0, 1, 0}) < 1e-12);
  CHECK(std::fabs(dot(f.element.point - lean.p, f.element.direction)) < 1e-12);
  CHECK(f.element.high - f.element.low < 1e-12);
  CHECK(f.element.end == Approx(std::hypot(20, 3)).epsilon(1e-4));
  // A bump of 0.04 amid four corners of each face leaves it by 4/5 of that, and the corners at -1/5: out of the width.
  std::vector<Vec3> bumped;
  for (const double side : {-1.0, 1.0})
    for (const auto& [x, z, bump] :
         {std::tuple{-20.0, -9.0, 0.0}, {20.0, -9.0, 0.0}, {-20.0, 9.0, 0.0}, {20.0, 9.0, 0.0}, {0.0, 0.0, 0.04}})
      bumped.push_back({x, side * (5 + bump), z});
  const Element rough = fit(Shape::parallel_planes, bumped, start).element;
  CHECK(rough.high == Approx(0.032));
  CHECK(rough.low == Approx(-0.008));
  CHECK(fit(Shape::symmetry_plane, {{0, 1, 0}, {9, 1, 0}, {0, 1, 9}, {9, 1, 9}}, start).failure ==
        "all touches lie on one side of the nominal median plane");
}

TEST_CASE("Patterns lie on the nominal surface and face away from the material") {
  const Element round{
      .point = {1, 2, 3}, .direction = {0, 0, 1}, .size = 8, .second = {1, 0, 0}, .angle = kPi, .begin = 0, .end = 30};
  for (const FeatureKind* kind : feature_kinds()) {
    CAPTURE(std::string(kind->word));
    Element e = round;
    e.minor_size = 4;
    if (kind->shape == Shape::slot) e.angle = 0;
    const auto any = pattern_touch(*kind, e, false, 0, 7);
    CHECK(static_cast<bool>(any) == !kind->pattern.help.empty());
    if (!any) continue;
    for (const bool inner : {false, true})
      for (int k = 0; k < 14; ++k) {
        const PatternTouch touch = pattern_touch(*kind, e, inner, k, 14).value;
        CHECK(norm(touch.normal) == Approx(1));
        const auto normal = nominal_normal(*kind, e, inner, touch.point);
        REQUIRE(normal);
        CHECK(norm(normal.value - touch.normal) < 1e-9);
      }
  }
  const auto fourth = pattern_touch(feature_kind(Shape::circle), round, true, 1, 4).value;
  CHECK(norm(fourth.point - Vec3{1, 10, 3}) < 1e-12);
  CHECK(norm(fourth.normal - Vec3{0, -1, 0}) < 1e-12);
}

TEST_CASE("A pattern determines its feature") {
  for (const FeatureKind* kind : feature_kinds()) {
    if (!kind->pattern.touch || kind->shape == Shape::line) continue;
    const int fewest = pattern_minimum(*kind);
    for (const int count : {fewest, fewest + 1, 9, 16}) {
      Element e{.point = {1, 2, 3},
                .direction = {0, 0, 1},
                .size = 8,
                .minor_size = 4,
                .second = {1, 0, 0},
                .angle = kPi,
                .end = 30};
      if (kind->shape == Shape::slot) e.angle = 0;
      CAPTURE(std::string(kind->word));
      CAPTURE(count);
      CHECK(fit(kind->shape, touches(kind->shape, e, count), e).failure == "");
    }
  }
}
