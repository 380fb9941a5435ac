// The registry of feature kinds and the nominal elements they make of arguments.
#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "engine/features/feature.hpp"
#include "engine/features/nominal_normal.hpp"
#include "engine/features/pattern.hpp"

using namespace abbe;

namespace {

Arguments arguments(std::initializer_list<std::pair<const char*, double>> values) {
  Arguments a;
  for (const auto& [name, value] : values) a.add_number(name, value);
  return a;
}

Outcome<Element> nominal(std::string_view word, std::initializer_list<std::pair<const char*, double>> values) {
  return find_feature_kind(word)->nominal(arguments(values));
}

void check_vector(const Vec3& a, const Vec3& b) { CHECK(norm(a - b) < 1e-12); }

}  // namespace

TEST_CASE("every shape has one kind, fully described") {
  std::set<std::string_view> words;
  for (const FeatureKind* kind : feature_kinds()) {
    CHECK(&feature_kind(kind->shape) == kind);
    CHECK(find_feature_kind(kind->word) == kind);
    CHECK(words.insert(kind->word).second);
    CHECK(kind->example.find(kind->word) != std::string_view::npos);
    for (const std::string_view text : {kind->help, kind->source}) CHECK_FALSE(text.empty());
    if (kind->signature.empty()) CHECK((kind->pattern.touch == nullptr));  // a GSURF: its nominal says nothing
    CHECK(kind->minimum_points > 0);
    CHECK((kind->nominal != nullptr));
    CHECK((kind->written != nullptr));
    CHECK((kind->fit_lanes != nullptr));
    CHECK((kind->normal != nullptr));
  }
  CHECK(find_feature_kind("CYLINDER") == nullptr);
}

TEST_CASE("what a kind says of itself hangs together") {
  for (const FeatureKind* kind : feature_kinds()) {
    CAPTURE(std::string(kind->word));
    CHECK(feature_kind(kind->acts_as).acts_as == kind->acts_as);
    CHECK(kind->pattern.help.empty() == !kind->pattern.touch);
    if (kind->pattern.minimum) CHECK(kind->pattern.minimum > kind->minimum_points);
    if (kind->refit) CHECK((kind->fit_points != nullptr));
    if (kind->fit_points) CHECK(kind->minimum_points > kind->spread);
    if (!kind->fit_names.element.empty()) CHECK((kind->fit_points && !kind->fit_names.point.empty()));
  }
}

TEST_CASE("diameters become radii and vectors unit vectors") {
  const auto e =
      nominal("CYLNDR", {{"x", 1}, {"y", 2}, {"z", 3}, {"i", 0}, {"j", 3}, {"k", 4}, {"diam", 10}, {"length", 7}});
  REQUIRE(e);
  check_vector(e.value.point, {1, 2, 3});
  check_vector(e.value.direction, {0, 0.6, 0.8});
  CHECK(e.value.size == 5);
  CHECK(e.value.begin == 0);
  CHECK(e.value.end == 7);
}

TEST_CASE("polar locations turn about z") {
  const auto e = nominal("POINT", {{"r", 2}, {"a", kPi / 2}, {"h", 5}, {"k", 1}});
  REQUIRE(e);
  check_vector(e.value.point, {0, 2, 5});
}

TEST_CASE("bounded lines are given by their ends, unbounded ones by point and direction") {
  const auto bounded = nominal("LINE", {{"x1", 0}, {"y1", 0}, {"z1", 1}, {"x2", 8}, {"y2", 0}, {"z2", 1}});
  REQUIRE(bounded);
  check_vector(bounded.value.point, {4, 0, 1});
  check_vector(bounded.value.direction, {1, 0, 0});
  CHECK(bounded.value.begin == -4);
  CHECK(bounded.value.end == 4);
  const auto unbounded = nominal("LINE", {{"x", 5}, {"i", -2}});
  REQUIRE(unbounded);
  check_vector(unbounded.value.direction, {-1, 0, 0});
  CHECK(unbounded.value.end == 0);
}

TEST_CASE("the angle of a cone is the full one, the sizes of a torus are diameters") {
  const auto cone = nominal("CONE", {{"k", 1}, {"angle", kPi / 3}});
  REQUIRE(cone);
  CHECK(cone.value.angle == doctest::Approx(kPi / 6));
  CHECK(cone.value.size == 0);
  const auto torus = nominal("TORUS", {{"k", 1}, {"majdia", 80}, {"mindia", 20}});
  REQUIRE(torus);
  CHECK(torus.value.size == 40);
  CHECK(torus.value.minor_size == 10);
}

// The radius of a cone of 60 degrees grows by tan 30 along its direction: out of a shaft the normal leads away from the
// axis and back to the apex, square to the generator (sin 30, cos 30).
TEST_CASE("the normal of a cone leads away from the axis and back to the apex") {
  const double c = std::sqrt(0.75);
  const Element up = nominal("CONE", {{"x", 1}, {"y", 2}, {"z", 3}, {"i", 0}, {"k", 1}, {"angle", kPi / 3}}).value;
  const Element along = nominal("CONE", {{"i", -1}, {"angle", kPi / 3}}).value;
  const FeatureKind& cone = feature_kind(Shape::cone);
  check_vector(nominal_normal(cone, up, false, {1, 7, 13}).value, {0, c, -0.5});
  check_vector(nominal_normal(cone, up, true, {1, 7, 13}).value, {0, -c, 0.5});
  check_vector(nominal_normal(cone, along, false, {-10, 0, -5}).value, {0.5, 0, -c});
}

TEST_CASE("the vector of a sphere leads to its pole, where its default touches begin") {
  const Element ball = nominal("SPHERE", {{"x", 1}, {"diam", 20}, {"j", -2}, {"i", 0}, {"k", 0}}).value;
  for (const bool inner : {false, true}) {
    check_vector(pattern_touch(feature_kind(Shape::sphere), ball, inner, 0, 5).value.point, {1, inner ? 10. : -10., 0});
    for (int k = 1; k < 5; ++k)
      CHECK(pattern_touch(feature_kind(Shape::sphere), ball, inner, k, 5).value.point.y == doctest::Approx(0));
  }
}

TEST_CASE("impossible values fail with a reason") {
  for (const std::string_view word : {"POINT", "LINE", "PLANE", "CIRCLE", "CYLNDR", "CONE", "TORUS"})
    CHECK_FALSE(nominal(word, {{"diam", 10}, {"angle", 1}, {"majdia", 8}, {"mindia", 2}}));  // zero vector
  for (const std::string_view word : {"PLANE", "CIRCLE"}) CHECK_FALSE(nominal(word, {{"diam", 10}, {"i", INFINITY}}));
  for (const std::string_view word : {"CIRCLE", "CYLNDR", "SPHERE"}) {
    CHECK_FALSE(nominal(word, {{"k", 1}, {"diam", 0}}));
    CHECK_FALSE(nominal(word, {{"k", 1}, {"diam", -4}}));
  }
  CHECK_FALSE(nominal("CYLNDR", {{"k", 1}, {"diam", 4}, {"length", 0}}));
  CHECK_FALSE(nominal("CONE", {{"k", 1}, {"angle", 0}}));
  CHECK_FALSE(nominal("CONE", {{"k", 1}, {"angle", kPi}}));
  CHECK_FALSE(nominal("TORUS", {{"k", 1}, {"majdia", 0}, {"mindia", 1}}));
  CHECK_FALSE(nominal("TORUS", {{"k", 1}, {"majdia", 9}, {"mindia", -1}}));
  CHECK_FALSE(nominal("LINE", {{"x1", 3}, {"x2", 3}}));
  CHECK_FALSE(nominal("ARC", {{"k", 1}, {"radius", 0}, {"sweep", 1}}));
  CHECK_FALSE(nominal("ARC", {{"k", 1}, {"radius", 2}, {"sweep", 0}}));
  CHECK_FALSE(nominal("EDGEPT", {{"k", 1}}));  // no surface beside it
  CHECK_FALSE(nominal("CPARLN", {{"k", 1}, {"i2", 1}, {"length", 10}, {"width", 12}}));
  CHECK_FALSE(nominal("CPARLN", {{"k", 1}, {"i2", 1}, {"k2", 1}, {"length", 30}, {"width", 12}}));
  CHECK_FALSE(nominal("RCTNGL", {{"i1", 1}, {"len1", 60}, {"i2", 1}, {"len2", 40}, {"k3", 1}, {"len3", 20}}));
  CHECK_FALSE(nominal("ELLIPS", {{"x1", -30}, {"x2", 30}, {"diam", 0}, {"k", 1}}));
  CHECK_FALSE(nominal("PARPLN", {{"j", 1}, {"width", 0}}));
  CHECK_FALSE(nominal("PARPLN", {{"i1", 1}, {"j2", 1}, {"x2", 10}}));
  CHECK_FALSE(nominal("SYMPLN", {{"width", 10}}));
}

TEST_CASE("arcs start where they say") {
  const auto arc = nominal("ARC", {{"x", 5}, {"k", 1}, {"radius", 20}, {"start", kPi / 2}, {"sweep", kPi}});
  REQUIRE(arc);
  CHECK(arc.value.size == 20);
  CHECK(arc.value.angle == doctest::Approx(kPi));
  check_vector(arc.value.second, {0, 1, 0});
  // x runs along the normal
  check_vector(nominal("ARC", {{"i", 1}, {"radius", 20}, {"sweep", 1}}).value.second, {0, 1, 0});
  check_vector(nominal("ARC", {{"k", 1}, {"radius", 20}, {"sweep", 1}, {"is", 0}, {"js", -2}, {"ks", 0}}).value.second,
               {0, -1, 0});
}

TEST_CASE("two-sided features keep halves") {
  const auto slot = nominal("CPARLN", {{"x", 1}, {"k", 1}, {"j2", 2}, {"length", 30}, {"width", 10}});
  REQUIRE(slot);
  CHECK(slot.value.size == 15);
  CHECK(slot.value.minor_size == 5);
  check_vector(slot.value.second, {0, 1, 0});
  Arguments ellipse = arguments({{"x1", -30}, {"x2", 30}, {"diam", 100}, {"k", 1}});
  ellipse.add_text("axis", "MAJOR");
  CHECK(find_feature_kind("ELLIPS")->nominal(ellipse).value.minor_size == doctest::Approx(40));
  const auto minor = nominal("ELLIPS", {{"x1", -30}, {"x2", 30}, {"diam", 80}, {"k", 1}});
  CHECK(minor.value.size == doctest::Approx(50));
  const auto planes = nominal("PARPLN", {{"y1", 3}, {"j1", -1}, {"y2", 13}, {"j2", 1}});
  REQUIRE(planes);
  check_vector(planes.value.point, {0, 8, 0});
  CHECK(planes.value.size == 5);
  // Points of the faces need not lie opposite each other.
  CHECK(nominal("PARPLN", {{"x1", 40}, {"y1", 3}, {"j1", -1}, {"y2", 13}, {"j2", 1}}).value.size == 5);
  CHECK(
      nominal("RCTNGL", {{"i1", 1}, {"len1", 60}, {"j2", 1}, {"len2", 40}, {"k3", 1}, {"len3", 20}}).value.minor_size ==
      20);
}
