#include <doctest/doctest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "tests/unit/features/operands.hpp"

using namespace abbe;

namespace {

Operand plane(Vec3 point, Vec3 normal) { return {Shape::plane, {.point = point, .direction = unit(normal)}}; }
Operand cylinder(Vec3 at, Vec3 axis, double radius) {
  return {Shape::cylinder, {.point = at, .direction = unit(axis), .size = radius}};
}
Operand sphere(Vec3 at, double radius) { return {Shape::sphere, {.point = at, .size = radius}}; }

Outcome<Element> build(const char* word, Shape result, const std::vector<Operand>& operands, Vec3 nominal = {0, 0, 1},
                       const Arguments& arguments = {}) {
  std::vector<Shape> shapes;
  std::vector<Element> elements;
  for (const Operand& o : operands) shapes.push_back(o.shape), elements.push_back(o.element);
  const Construction* method = find_construction(word);
  REQUIRE(method);
  if (const char* why_not = method->applies(result, shapes)) return Outcome<Element>::failed(why_not);
  return method->construct(result, shapes, elements, {.point = {}, .direction = unit(nominal)}, arguments);
}

Element made(const char* word, Shape result, const std::vector<Operand>& operands, Vec3 nominal = {0, 0, 1},
             const Arguments& arguments = {}) {
  const Outcome<Element> outcome = build(word, result, operands, nominal, arguments);
  INFO(std::string(outcome.failure ? outcome.failure : ""));
  REQUIRE(outcome);
  return outcome.value;
}

std::string reason(const char* word, Shape result, const std::vector<Operand>& operands) {
  const Outcome<Element> outcome = build(word, result, operands);
  return outcome ? "" : outcome.failure;
}

}  // namespace

TEST_CASE("Every construction describes itself and is found by its word") {
  std::set<std::string_view> words;
  for (const Construction* c : constructions()) {
    CAPTURE(std::string(c->word));
    CHECK(words.insert(c->word).second);
    CHECK(find_construction(c->word) == c);
    CHECK_FALSE(c->help.empty());
    CHECK_FALSE(c->source.empty());
    CHECK(c->example.find(c->word) != std::string_view::npos);
    CHECK(c->signature.find("from:feature") != std::string_view::npos);
  }
  CHECK(find_construction("TANGLE") == nullptr);
}

TEST_CASE("INTOF of planes") {
  // z = 2 and x + z = 5 meet where x = 3.
  const std::vector<Operand> two = {plane({1, 1, 2}, {0, 0, 1}), plane({5, 7, 0}, {1, 0, 1})};
  const Element l = made("INTOF", Shape::line, two, {0, -1, 0.1});
  check_near(l.direction, {0, -1, 0});
  check_near(l.point, {3, 4, 2});  // half way between the y of the planes' points
  check_near(made("INTOF", Shape::line, two, {0, 1, 0}).direction, {0, 1, 0});
  const std::vector<Operand> three = {plane({9, 9, 1}, {0, 0, 1}), plane({2, 9, 9}, {-1, 0, 0}),
                                      plane({1, 3, 0}, {1, 1, 0})};
  check_near(made("INTOF", Shape::point, three).point, {2, 2, 1});
  CHECK(reason("INTOF", Shape::line, {plane({}, {0, 0, 1}), plane({0, 0, 1}, {0, 0, -1})}) ==
        "the planes are parallel");
  CHECK(reason("INTOF", Shape::point, {plane({}, {0, 0, 1}), plane({}, {1, 0, 0}), plane({}, {1, 0, 1})}) ==
        "two of the planes are parallel, or all three run along one direction");
  CHECK(reason("INTOF", Shape::line, three) == "three planes meet in a point");
  CHECK(reason("INTOF", Shape::point, {plane({}, {0, 0, 1}), plane({}, {1, 0, 0}), line({}, {1, 0, 1})}) ==
        "INTOF of three features takes three planes");
}

TEST_CASE("INTOF of axes") {
  const Element pierced = made("INTOF", Shape::point, {line({0, 0, 0}, {1, 2, 3}), plane({7, 7, 6}, {0, 0, 1})});
  check_near(pierced.point, {2, 4, 6});
  check_near(made("INTOF", Shape::point, {plane({7, 7, 6}, {0, 0, 1}), cylinder({1, 2, 3}, {0, 0, 1}, 5)}).point,
             {1, 2, 6});
  // Lines 2 mm apart in height cross at (3, 4), half way up.
  check_near(made("INTOF", Shape::point, {line({0, 4, 1}, {1, 0, 0}), line({5, 6, 3}, {1, 1, 0})}).point, {3, 4, 2});
  CHECK(reason("INTOF", Shape::point, {line({}, {1, 0, 0}), line({0, 1, 0}, {1, 1e-4, 0})}) ==
        "the lines are parallel");
  CHECK(reason("INTOF", Shape::point, {line({}, {1, 0, 0}), plane({}, {0, 0, 1})}) ==
        "the line is parallel to the plane");
  CHECK(reason("INTOF", Shape::point, {point({}), point({})}).starts_with("INTOF makes"));
}

TEST_CASE("INTOF sections") {
  const Element of_sphere = made("INTOF", Shape::circle, {sphere({1, 2, 3}, 5), plane({0, 0, 7}, {0, 0, -1})});
  check_near(of_sphere.point, {1, 2, 7});
  CHECK(of_sphere.size == doctest::Approx(3));
  check_near(of_sphere.direction, {0, 0, 1});
  const Element of_cylinder =
      made("INTOF", Shape::circle, {plane({0, 0, 7}, {0, 0, 1}), cylinder({1, 2, 0}, {0, 0, 1}, 4)});
  check_near(of_cylinder.point, {1, 2, 7});
  CHECK(of_cylinder.size == 4);
  const Operand cone{Shape::cone, {.point = {0, 0, 10}, .direction = {0, 0, 1}, .size = 10, .angle = kPi / 4}};
  CHECK(made("INTOF", Shape::circle, {plane({0, 0, 7}, {0, 0, 1}), cone}).size == doctest::Approx(7));
  CHECK(reason("INTOF", Shape::circle, {plane({0, 0, -1}, {0, 0, 1}), cone}) ==
        "the plane lies beyond the apex of the cone");
  CHECK(reason("INTOF", Shape::circle, {plane({0, 0, 9}, {0, 0, 1}), sphere({}, 5)}) ==
        "the plane does not cut the sphere");
  CHECK(reason("INTOF", Shape::circle, {plane({}, {0, 0.1, 1}), cylinder({}, {0, 0, 1}, 4)}) ==
        "the section is not a circle: the plane is not square to the axis");
}

TEST_CASE("Halfway between features") {
  check_near(made("MIDPT", Shape::point, {point({1, 2, 3}), sphere({3, 2, 7}, 1)}).point, {2, 2, 5});
  CHECK(reason("MIDPT", Shape::line, {point({}), point({})}) == "MIDPT makes a point");

  const Element parallel_lines =
      made("MIDLI", Shape::line, {line({0, 0, 0}, {1, 0, 0}), line({4, 6, 2}, {-1, 0, 0})}, {-1, 0, 0});
  check_near(parallel_lines.point, {2, 3, 1});
  check_near(parallel_lines.direction, {-1, 0, 0});
  // The x axis and the line at 60 degrees through the origin: the bisector at 30 degrees passes
  // through the origin.
  const Vec3 at60{0.5, std::sqrt(0.75), 0}, at30{std::sqrt(0.75), 0.5, 0};
  const Element bisecting = made("MIDLI", Shape::line, {line({10, 0, 0}, {1, 0, 0}), line(4 * at60, at60)}, {1, 0, 0});
  check_near(bisecting.direction, at30);
  check_near(cross(bisecting.point, at30), {});
  // Below 45 degrees it is the one in the acute angle, whatever the nominal says.
  const Vec3 at40{std::cos(2 * kPi / 9), std::sin(2 * kPi / 9), 0};
  check_near(made("MIDLI", Shape::line, {line({}, {1, 0, 0}), line({}, at40)}, {1, -3, 0}).direction,
             -unit(at40 + Vec3{1, 0, 0}));
  // Lines at a right angle have two bisectors: the nominal chooses.
  check_near(made("MIDLI", Shape::line, {line({}, {1, 0, 0}), line({}, {0, 1, 0})}, {1, -1, 0}).direction,
             unit({1, -1, 0}));
  check_near(made("MIDLI", Shape::line, {line({}, {1, 0, 0}), line({}, {0, 1, 0})}, {1, 1, 0}).direction,
             unit({1, 1, 0}));

  const Element slot =
      made("MIDPL", Shape::plane, {plane({3, 1, 0}, {0, 1, 0}), plane({5, 9, 0}, {0, -1, 0})}, {0, -1, 0});
  check_near(slot.point, {4, 5, 0});
  check_near(slot.direction, {0, -1, 0});
  // Planes y = x and y = 0 through the z axis, 45 degrees: the middle one contains the z axis.
  const Element wedge =
      made("MIDPL", Shape::plane, {plane({8, 0, 3}, {0, 1, 0}), plane({5, 5, 0}, {-1, 1, 0})}, {0, 1, 0});
  check_near(wedge.direction, {-std::sin(kPi / 8), std::cos(kPi / 8), 0});
  CHECK(std::fabs(dot(wedge.point, wedge.direction)) < 1e-12);
  CHECK(reason("MIDLI", Shape::line, {point({}), line({}, {1, 0, 0})}) == "MIDLI makes a line of two lines or axes");
  CHECK(reason("MIDPL", Shape::plane, {point({}), plane({}, {1, 0, 0})}) == "MIDPL makes a plane of two planes");
}

TEST_CASE("Projections") {
  check_near(made("PROJPT", Shape::point, {point({1, 2, 3}), plane({9, 9, 1}, {0, 0, -1})}).point, {1, 2, 1});
  check_near(made("PROJPT", Shape::point, {point({1, 2, 3}), line({0, 0, 0}, {1, 1, 0})}).point, {1.5, 1.5, 0});
  CHECK(reason("PROJPT", Shape::point, {point({}), sphere({}, 1)}) ==
        "PROJPT projects onto a plane, a line or an axis");
  CHECK(reason("PROJPT", Shape::plane, {point({}), plane({}, {0, 0, 1})}) == "PROJPT makes a point");
  Operand slanted = line({0, 0, 5}, {0, 3, 4});
  slanted.element.begin = -5, slanted.element.end = 10;
  const Element shadow = made("PROJLI", Shape::line, {slanted, plane({}, {0, 0, 1})}, {0, -1, 0});
  check_near(shadow.point, {0, 0, 0});
  check_near(shadow.direction, {0, -1, 0});
  CHECK(shadow.begin == doctest::Approx(-6));
  CHECK(shadow.end == doctest::Approx(3));
  CHECK(reason("PROJLI", Shape::line, {line({}, {0, 0, 1}), plane({}, {0, 0, 1})}) ==
        "the line is perpendicular to the plane");
  CHECK(reason("PROJLI", Shape::line, {point({}), plane({}, {0, 0, 1})}) ==
        "PROJLI projects a line or an axis onto a plane");
}

TEST_CASE("Perpendicular and parallel through a feature") {
  const Element dropped = made("PERPTO", Shape::line, {plane({}, {0, 0, 1}), point({1, 2, 3})}, {0, 0, -1});
  check_near(dropped.point, {1, 2, 3});
  check_near(dropped.direction, {0, 0, -1});
  check_near(made("PERPTO", Shape::line, {line({}, {1, 0, 0}), point({4, 3, 0})}, {0, 1, 0}).direction, {0, 1, 0});
  check_near(made("PERPTO", Shape::plane, {line({}, {1, 0, 0}), point({4, 3, 0})}, {-1, 0, 0}).direction, {-1, 0, 0});
  check_near(made("PERPTO", Shape::plane, {plane({}, {0, 0, 1}), line({4, 3, 0}, {1, 0, 0})}, {0, 1, 0}).direction,
             {0, 1, 0});
  CHECK(reason("PERPTO", Shape::line, {line({}, {1, 0, 0}), point({4, 0, 0})}) ==
        "the point lies on the line to which the new one should be perpendicular");
  CHECK(reason("PERPTO", Shape::plane, {plane({}, {0, 0, 1}), line({}, {0, 0, 1})}) ==
        "the line is perpendicular to the plane, so that no single plane contains it");
  CHECK(reason("PERPTO", Shape::plane, {plane({}, {0, 0, 1}), point({})}).starts_with("PERPTO makes"));
  const Element shelf = made("PARTO", Shape::plane, {plane({}, {0, 0, 1}), point({4, 3, 2})});
  check_near(shelf.point, {4, 3, 2});
  check_near(shelf.direction, {0, 0, 1});
  check_near(made("PARTO", Shape::line, {cylinder({}, {0, 0, 1}, 2), point({4, 3, 2})}, {0, 0, -1}).direction,
             {0, 0, -1});
  CHECK(reason("PARTO", Shape::line, {plane({}, {0, 0, 1}), point({})}).starts_with("PARTO makes"));
}

TEST_CASE("Moved and gathered features") {
  Arguments by;
  by.add_number("dx", 1), by.add_number("dy", -2), by.add_number("dz", 3);
  check_near(made("MOVEPT", Shape::point, {point({10, 10, 10})}, {0, 0, 1}, by).point, {11, 8, 13});
  Arguments distance;
  distance.add_number("distance", -5);
  check_near(made("MOVEPT", Shape::point, {point({1, 1, 1}), line({}, {0, 3, 4})}, {0, 0, 1}, distance).point,
             {1, -2, -3});
  CHECK(reason("MOVEPT", Shape::point, {point({}), sphere({}, 1)}) == "a sphere has no direction along which to move");
  CHECK(reason("MOVEPT", Shape::line, {point({})}) == "MOVEPT makes a point");
  check_near(made("OFFSET", Shape::plane, {plane({1, 1, 1}, {0, 0, 1})}, {0, 0, 1}, distance).point, {1, 1, -4});
  CHECK(reason("OFFSET", Shape::line, {line({}, {1, 0, 0})}) == "OFFSET makes a plane of a plane");
  check_near(made("COG", Shape::point, {point({0, 0, 0}), sphere({3, 0, 0}, 1), point({0, 3, 6})}).point, {1, 1, 2});
  CHECK(reason("COG", Shape::circle, {point({})}) == "COG makes a point");
  CHECK(made("TR", Shape::sphere, {sphere({1, 2, 3}, 4)}).size == 4);
  CHECK(reason("TR", Shape::sphere, {point({})}) == "TR takes over a feature of the same kind");
}

TEST_CASE("A cone stands for its apex where a point is asked for") {
  // Touched 8 mm above its apex at (1, 2, 3).
  const Operand cone{Shape::cone, {.point = {1, 2, 11}, .size = 8 * std::tan(0.4), .angle = 0.4}};
  const Operand top = plane({0, 0, 9}, {0, 0, 1}), spot = point({1, 2, 5});
  Arguments by;
  by.add_number("dx", 0), by.add_number("dy", 0), by.add_number("dz", -1);
  check_near(made("MIDPT", Shape::point, {cone, spot}).point, {1, 2, 4});
  check_near(made("COG", Shape::point, {cone, spot}).point, {1, 2, 4});
  check_near(made("MOVEPT", Shape::point, {cone}, {0, 0, 1}, by).point, {1, 2, 2});
  check_near(made("PROJPT", Shape::point, {cone, line({0, 0, 0}, {0, 0, 1})}).point, {0, 0, 3});
  check_near(made("PARTO", Shape::plane, {top, cone}).point, {1, 2, 3});
  check_near(made("PERPTO", Shape::line, {top, cone}).point, {1, 2, 3});
  check_near(made("VECBLD", Shape::point, {cone, point({5, 2, 3}), point({1, 9, 3})}).direction, {0, 0, 1});
  check_near(made("BF", Shape::line, {cone, point({5, 2, 3})}, {1, 0, 0}).direction, {1, 0, 0});
  const Element same = made("TR", Shape::cone, {cone});
  check_near(same.point, cone.element.point);
  CHECK(same.size == cone.element.size);
}

TEST_CASE("BF through features") {
  const Element flat =
      made("BF", Shape::plane,
           {point({0, 0, 0.1}), point({10, 0, -0.1}), sphere({10, 10, 0.1}, 2), point({0, 10, -0.1})}, {0, 0, -1});
  check_near(flat.direction, {0, 0, -1}, 1e-9);
  CHECK(flat.point.z == doctest::Approx(0).scale(1));
  CHECK(flat.low == doctest::Approx(-0.1));
  CHECK(flat.high == doctest::Approx(0.1));
  const Element bolts = made(
      "BF", Shape::circle, {sphere({5, 0, 1}, 1), sphere({0, 5, 1}, 1), sphere({-5, 0, 1}, 1), sphere({0, -5, 1}, 1)});
  check_near(bolts.point, {0, 0, 1}, 1e-9);
  CHECK(bolts.size == doctest::Approx(5));
  const Element row = made("BF", Shape::line, {point({0, 1, 0}), point({10, 1, 0}), point({20, 1, 0})}, {-1, 0, 0});
  check_near(row.direction, {-1, 0, 0}, 1e-9);
  CHECK(row.end - row.begin == doctest::Approx(20));
  CHECK(reason("BF", Shape::plane, {point({0, 0, 0}), point({1, 0, 0}), point({2, 0, 0})}) ==
        "the points of the features lie on one line");
  CHECK(reason("BF", Shape::plane, {point({0, 0, 0}), point({1, 0, 0})}) ==
        "too few features for a best fit of this kind");
  CHECK(reason("BF", Shape::line, {point({1, 1, 1}), point({1, 1, 1})}) == "the points of the features are identical");
  CHECK(reason("BF", Shape::sphere, {point({0, 0, 0}), point({1, 0, 0}), point({0, 1, 0}), point({1, 1, 0})}) ==
        "the points of the features lie in one plane");
  CHECK(reason("BF", Shape::plane, {plane({}, {0, 0, 1})}) == "BF takes features with a point, a centre or an axis");
}
