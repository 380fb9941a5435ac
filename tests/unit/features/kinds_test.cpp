// The registry of feature kinds and the nominal elements they make of arguments.
#include <doctest/doctest.h>

#include <set>

#include "engine/features/feature.hpp"

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
    for (const std::string_view text : {kind->signature, kind->help, kind->source}) CHECK_FALSE(text.empty());
    CHECK(kind->minimum_points > 0);
    CHECK((kind->nominal != nullptr));
    CHECK((kind->fit_lanes != nullptr));
  }
  CHECK(words.size() == 8);
  CHECK(find_feature_kind("ELLIPS") == nullptr);
}

TEST_CASE("diameters become radii and vectors unit vectors") {
  const auto e = nominal("CYLNDR", {{"x", 1}, {"y", 2}, {"z", 3}, {"i", 0}, {"j", 3}, {"k", 4}, {"diam", 10}, {"length", 7}});
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

TEST_CASE("impossible values fail with a reason") {
  for (const std::string_view word : {"POINT", "LINE", "PLANE", "CIRCLE", "CYLNDR", "CONE", "TORUS"})
    CHECK_FALSE(nominal(word, {{"diam", 10}, {"angle", 1}, {"majdia", 8}, {"mindia", 2}}));  // zero vector
  for (const std::string_view word : {"PLANE", "CIRCLE"})
    CHECK_FALSE(nominal(word, {{"diam", 10}, {"i", INFINITY}}));
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
}
