// Tangents, extreme points, built vectors and intersections with round features.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/unit/features/operands.hpp"

using namespace abbe;

namespace {

Operand circle(Vec3 at, double radius, Vec3 normal = {0, 0, 1}) {
  return {Shape::circle, {.point = at, .direction = normal, .size = radius}};
}

Outcome<Element> build_near(const char* word, Shape result, const std::vector<Operand>& operands,
                            const Element& nominal = {}, const Arguments& arguments = {}) {
  std::vector<Shape> shapes;
  std::vector<Element> elements;
  for (const Operand& o : operands) shapes.push_back(o.shape), elements.push_back(o.element);
  const Construction& method = *find_construction(word);
  if (const char* why_not = method.applies(result, shapes)) return Outcome<Element>::failed(why_not);
  return method.construct(result, shapes, elements, nominal, arguments);
}

Element made_near(const char* word, Shape result, const std::vector<Operand>& operands, const Element& nominal = {},
                  const Arguments& arguments = {}) {
  const Outcome<Element> outcome = build_near(word, result, operands, nominal, arguments);
  INFO(std::string(outcome.failure ? outcome.failure : ""));
  REQUIRE(outcome);
  return outcome.value;
}

std::string reason_near(const char* word, Shape result, const std::vector<Operand>& operands) {
  const Outcome<Element> outcome = build_near(word, result, operands);
  return outcome ? "" : outcome.failure;
}

Arguments extreme(const char* end, Vec3 along) {
  Arguments a;
  a.add_text("end", end);
  a.add_number("i", along.x), a.add_number("j", along.y), a.add_number("k", along.z);
  return a;
}

}  // namespace

TEST_CASE("The circle of a cone lies where it has the diameter, or at the distance from the apex") {
  // Apex at (1, 2, 3), 60 degrees full angle, opening along -x; the element has its point where it was touched.
  const double angle = kPi / 6, slope = std::tan(angle);
  const Operand cone{Shape::cone, {.point = {-39, 2, 3}, .direction = {-1, 0, 0}, .size = 40 * slope, .angle = angle}};
  Arguments diameter, distance, none;
  diameter.add_number("diameter", 12), distance.add_number("distance", 25), none.add_number("diameter", 0);
  const Element gauge = made_near("CONE", Shape::circle, {cone}, {.point = {}, .direction = {1, 0, 0}}, diameter);
  check_near(gauge.point, {1 - 6 / slope, 2, 3});
  check_near(gauge.direction, {1, 0, 0});
  CHECK(gauge.size == doctest::Approx(6));
  const Element section = made_near("CONE", Shape::circle, {cone}, {.point = {}, .direction = {-1, 0, 0}}, distance);
  check_near(section.point, {-24, 2, 3});
  check_near(section.direction, {-1, 0, 0});
  CHECK(section.size == doctest::Approx(25 * slope));
  CHECK_FALSE(build_near("CONE", Shape::circle, {cone}, {}, none));
  CHECK(reason_near("CONE", Shape::circle, {circle({}, 6)}) == "CONE makes a circle of a cone");
}

TEST_CASE("A tangent through a point touches at the right angle") {
  // From (10, 0) to the circle of radius 6 about 0: touching points at (3.6, +-4.8).
  const std::vector<Operand> both = {circle({0, 0, 1}, 6), point({10, 0, 5})};
  const Element upper = made_near("TANTO", Shape::line, both, {.point = {3, 5, 1}, .direction = {-1, 0, 0}});
  check_near(upper.point, {3.6, 4.8, 1});
  check_near(upper.direction, {-0.8, 0.6, 0});
  check_near(made_near("TANTO", Shape::line, {both[1], both[0]}, {.point = {3, -5, 1}, .direction = {1, 0, 0}}).point,
             {3.6, -4.8, 1});
  CHECK(reason_near("TANTO", Shape::line, {circle({}, 6), point({1, 0, 0})}) ==
        "there is no tangent: one lies inside the other");
  CHECK(reason_near("TANTO", Shape::line, {circle({}, 6), point({0, 0, 9})}) == "a tangent needs two different places");
  CHECK(reason_near("TANTO", Shape::plane, both).starts_with("TANTO makes"));
}

TEST_CASE("Tangents of two circles leave them on one side or on two") {
  const std::vector<Operand> belt = {circle({0, 0, 0}, 3), circle({10, 0, 0}, 3)};
  const Element open = made_near("TANTO", Shape::line, belt, {.point = {5, 3, 0}, .direction = {1, 0, 0}});
  check_near(open.direction, {1, 0, 0});
  check_near(open.point, {0, 3, 0});
  const Element crossed = made_near("TANTO", Shape::line, belt, {.point = {3, 2.4 - 0.9, 0}, .direction = {1, -1, 0}});
  check_near(crossed.point, {1.8, 2.4, 0});  // h = 6 / 10
  check_near(crossed.direction, {0.8, -0.6, 0});
  CHECK(std::fabs(dot(cross(Vec3{10, 0, 0} - crossed.point, crossed.direction), {0, 0, 1})) == doctest::Approx(3));
}

TEST_CASE("A fillet has the nominal size and touches both lines") {
  const Element nominal{.point = {4, 6, 0}, .direction = {0, 0, 1}, .size = 5};
  const Element e =
      made_near("TANTO", Shape::circle, {line({9, 0, 2}, {1, 0, 0}), line({0, 7, 2}, {0, 1, 0})}, nominal);
  check_near(e.point, {5, 5, 2});
  CHECK(e.size == 5);
  CHECK(reason_near("TANTO", Shape::circle, {line({}, {1, 0, 0}), line({0, 1, 0}, {1, 0, 0})}) ==
        "the lines are parallel");
  CHECK(reason_near("TANTO", Shape::circle, {line({}, {1, 0, 0}), line({}, {0, 1, 0})})
            .starts_with("the nominal circle says"));
}

TEST_CASE("Extreme points") {
  check_near(made_near("EXTREM", Shape::point, {{Shape::sphere, {.point = {1, 2, 3}, .size = 5}}}, {},
                       extreme("MAX", {0, 3, 4}))
                 .point,
             {1, 5, 7});
  check_near(made_near("EXTREM", Shape::point, {circle({1, 2, 3}, 5)}, {}, extreme("MIN", {1, 0, 1})).point,
             {-4, 2, 3});
  check_near(
      made_near("EXTREM", Shape::point, {line({0, 0, 0}, {1, 0, 0}, -3, 8)}, {}, extreme("MAX", {1, 1, 0})).point,
      {8, 0, 0});
  const Operand rod{Shape::cylinder, {.point = {0, 0, 0}, .direction = {0, 0, 1}, .size = 2, .begin = -3, .end = 8}};
  check_near(made_near("EXTREM", Shape::point, {rod}, {}, extreme("MIN", {-1, 0, 1})).point, {2, 0, -3});
  Arguments z;
  z.add_text("end", "MAX"), z.add_text("along", "ZDIR");
  const Operand ring{Shape::torus, {.point = {0, 0, 1}, .direction = {0, 0, 1}, .size = 20, .minor_size = 4}};
  check_near(made_near("EXTREM", Shape::point, {ring}, {}, z).point, {0, 0, 5});
  CHECK(reason_near("EXTREM", Shape::point, {rod}) == "the direction of EXTREM has no length");
  CHECK_FALSE(build_near("EXTREM", Shape::point, {{Shape::cone, {}}}, {}, z));
  CHECK_FALSE(build_near("EXTREM", Shape::line, {rod}, {}, z));
}

TEST_CASE("The extreme point of a plane is on the disc of its touches, if it leans") {
  const auto roof = [](Vec3 normal) {
    return Operand{Shape::plane, {.point = {1, 2, 3}, .direction = unit(normal), .begin = -10, .end = 10}};
  };
  check_near(made_near("EXTREM", Shape::point, {roof({-3, 0, 4})}, {}, extreme("MAX", {0, 0, 1})).point, {9, 2, 9});
  check_near(made_near("EXTREM", Shape::point, {roof({-3, 0, 4})}, {}, extreme("MIN", {0, 0, 1})).point, {-7, 2, -3});
  for (const double lean : {0.0, 0.002, -0.01}) {
    const Outcome<Element> level =
        build_near("EXTREM", Shape::point, {roof({lean, 0, 1})}, {}, extreme("MAX", {0, 0, 1}));
    REQUIRE_FALSE(level);
    CHECK(std::string(level.failure).starts_with("the plane lies across the direction of EXTREM"));
  }
}

TEST_CASE("A vector is built of its neighbours") {
  const std::vector<Operand> three = {point({0, 0, 1}), point({10, 0, 1}), point({0, 10, 11})};
  const Element e = made_near("VECBLD", Shape::point, three, {.point = {}, .direction = {0, 0, 1}});
  check_near(e.point, {0, 0, 1});
  check_near(e.direction, unit({0, -1, 1}));
  CHECK(reason_near("VECBLD", Shape::point, {point({}), point({1, 0, 0}), point({2, 0, 0})}) ==
        "the points of the features do not determine a plane");
  CHECK(reason_near("VECBLD", Shape::plane, three) == "VECBLD makes a point");
}

TEST_CASE("INTOF with round features takes the point nearer to the nominal") {
  const Element right{.point = {9, 0, 0}}, left{.point = {-9, 0, 0}};
  const Operand ring = circle({1, 2, 3}, 5);
  check_near(made_near("INTOF", Shape::point, {line({0, 5, 9}, {1, 0, 0.2}), ring}, right).point, {5, 5, 3});
  check_near(made_near("INTOF", Shape::point, {ring, line({0, 5, 9}, {1, 0, 0})}, left).point, {-3, 5, 3});
  const Operand wall{Shape::plane, {.point = {0, 6, 0}, .direction = {0, 1, 0}}};
  check_near(made_near("INTOF", Shape::point, {wall, ring}, right).point, {4, 6, 3});
  const Operand ramp{Shape::plane, {.point = {0, 9, 0}, .direction = {0, 0.8, 0.6}}};  // at z = 3 it is at y = 6.75
  check_near(made_near("INTOF", Shape::point, {ramp, ring}, right).point, {1 + std::sqrt(25 - 4.75 * 4.75), 6.75, 3});
  check_near(
      made_near("INTOF", Shape::point, {circle({0, 0, 1}, 5), circle({6, 0, 1}, 5)}, {.point = {3, -9, 1}}).point,
      {3, -4, 1});
  const Operand ball{Shape::sphere, {.point = {0, 0, 0}, .size = 5}};
  check_near(made_near("INTOF", Shape::point, {line({0, 3, 0}, {0, 0, 1}), ball}, {.point = {0, 3, 9}}).point,
             {0, 3, 4});
  CHECK(reason_near("INTOF", Shape::point, {line({0, 9, 0}, {1, 0, 0}), ring}) ==
        "the line passes beside the circle or sphere");
  CHECK(reason_near("INTOF", Shape::point, {line({}, {0, 0, 1}), ring}) ==
        "the line stands on the plane of the circle");
  CHECK(reason_near("INTOF", Shape::point, {circle({}, 1), circle({9, 0, 0}, 1)}) == "the two circles do not meet");
  CHECK(reason_near("INTOF", Shape::point, {circle({}, 1), circle({}, 2)}) == "the two circles have one centre");
  CHECK(reason_near("INTOF", Shape::point, {circle({}, 1), circle({1, 0, 0}, 1, {1, 0, 0})}) ==
        "the two circles do not lie in parallel planes");
  CHECK(reason_near("INTOF", Shape::point, {{Shape::plane, {}}, ring}) ==
        "the plane is parallel to that of the circle");
}

TEST_CASE("A plane cuts a cylinder in an ellipse") {
  const Operand rod{Shape::cylinder, {.point = {1, 2, 0}, .direction = {0, 0, 1}, .size = 4}};
  const Operand slant{Shape::plane, {.point = {0, 0, 5}, .direction = unit({3, 0, 4})}};
  const Element e = made_near("INTOF", Shape::ellipse, {rod, slant});
  check_near(e.point, {1, 2, 4.25});
  CHECK(e.size == doctest::Approx(5));
  CHECK(e.minor_size == 4);
  CHECK(std::fabs(dot(e.second, unit({4, 0, -3}))) == doctest::Approx(1));
  for (const double sense : {1.0, -1.0})  // as the foci of the nominal stand
    CHECK(made_near("INTOF", Shape::ellipse, {rod, slant}, {.point = {}, .second = {sense, 0, 0}}).second.x ==
          doctest::Approx(0.8 * sense));
  CHECK(reason_near("INTOF", Shape::ellipse, {rod, {Shape::plane, {.point = {}, .direction = {1, 0, 0}}}}) ==
        "the plane runs along the axis of the cylinder");
}
