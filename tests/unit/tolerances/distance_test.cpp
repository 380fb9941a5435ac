#include "tests/unit/tolerances/evaluation.hpp"

using namespace abbe;
using namespace abbe::test;
using doctest::Approx;

namespace {

Evaluation nominal_distance(const char* word, const char* axis, double nominal, double lower, double upper) {
  Evaluation e(word);
  e.number("nominal", nominal).number("lower", lower).number("upper", upper).word("axis", axis);
  return e;
}

}  // namespace

TEST_CASE("DISTB along an axis and straight, unsigned") {
  const Element a = at({10, 20, 30}), b = at({7, 24, 42});
  for (const auto& [axis, distance] : {std::pair{"XAXIS", 3.0}, {"YAXIS", 4.0}, {"ZAXIS", 12.0}, {"PT2PT", 13.0}}) {
    CHECK(nominal_distance("DISTB", axis, distance, -0.1, 0.1)
              .feature(Shape::point, a)
              .feature(Shape::point, b)
              .value() == Approx(distance));
    CHECK(nominal_distance("DISTB", axis, distance, -0.1, 0.1)
              .feature(Shape::point, b)
              .feature(Shape::point, a)
              .value() == Approx(distance));
  }
  Evaluation e = nominal_distance("DISTB", "XAXIS", 3, -0.1, 0.2);
  e.feature(Shape::point, a).feature(Shape::point, b);
  CHECK(e.nominal_value() == 3);
  CHECK(*e.limits().lower == Approx(2.9));
  CHECK(*e.limits().upper == Approx(3.2));
  CHECK(e.refusal().empty());
}

TEST_CASE("DISTB with LIMIT takes its nominal from the nominal features") {
  Evaluation e("DISTB");
  e.number("lower", 2.8)
      .number("upper", 3.1)
      .word("axis", "XAXIS")
      .feature(Shape::point, at({10, 0, 0}))
      .feature(Shape::point, at({7.1, 0, 0}), at({7, 0, 0}));
  CHECK(e.value() == Approx(2.9));
  CHECK(e.nominal_value() == Approx(3));
  CHECK(*e.limits().lower == 2.8);
  CHECK(*e.limits().upper == 3.1);
}

TEST_CASE("A lower limit of 0 or less bounds no distance without a sign, as none is less") {
  const auto limits = [](const char* axis, double nominal, double lower) {
    return nominal_distance("DISTB", axis, nominal, lower, 0.1)
        .feature(Shape::point, at({10, 0, 0}))
        .feature(Shape::point, at({10, 0, 0}))
        .limits();
  };
  for (const char* axis : {"XAXIS", "PT2PT"}) {
    CHECK_FALSE(limits(axis, 0, 0).lower);
    CHECK_FALSE(limits(axis, 25.4, -25.4).lower);
    CHECK(limits(axis, 0, 0.01).lower == 0.01);
    CHECK(limits(axis, 0, 0).upper == 0.1);
  }
  CHECK(limits("XAXIS", 0, -0.1).lower == -0.1);  // there a negative limit asks for the sign
  CHECK_FALSE(limits("PT2PT", 0, -0.1).lower);
}

TEST_CASE("A distance is signed where its limits allow negative values") {
  const Element a = at({10, 0, 0}), b = at({9.98, 0, 0});
  CHECK(nominal_distance("DISTB", "XAXIS", 0, -0.1, 0.1).feature(Shape::point, a).feature(Shape::point, b).value() ==
        Approx(-0.02));
  CHECK(nominal_distance("DISTB", "XAXIS", 0, -0.1, 0.1).feature(Shape::point, b).feature(Shape::point, a).value() ==
        Approx(0.02));
  CHECK(nominal_distance("DISTB", "XAXIS", 0, 0, 0.1).feature(Shape::point, a).feature(Shape::point, b).value() ==
        Approx(0.02));
  CHECK(nominal_distance("DISTB", "PT2PT", 0, -0.1, 0.1).feature(Shape::point, a).feature(Shape::point, b).value() ==
        Approx(0.02));
  CHECK(nominal_distance("DISTB", "PT2PT", 0, -0.1, 0.1).feature(Shape::point, a).feature(Shape::point, a).value() ==
        0);
}

TEST_CASE("MAX and MIN reach to the far and near ends") {
  auto value = [](const char* use, Shape s, const Element& a, Shape t, const Element& b) {
    return nominal_distance("DISTB", "XAXIS", 30, -1, 1).word("use", use).feature(s, a).feature(t, b).value();
  };
  const Element s = sized(at({0, 0, 0}), 5), t = sized(at({30, 9, 0}), 3);
  CHECK(value("MAX", Shape::sphere, s, Shape::sphere, t) == Approx(38));
  CHECK(value("MIN", Shape::sphere, s, Shape::sphere, t) == Approx(22));
  CHECK(value("MIN", Shape::sphere, t, Shape::sphere, s) == Approx(22));
  CHECK(value("AVG", Shape::sphere, s, Shape::sphere, t) == Approx(30));
  CHECK(value("MIN", Shape::sphere, s, Shape::sphere, sized(at({6, 0, 0}), 5)) == 0);
  // A circle square to x has no extent along it; one at 60 degrees reaches r sin 60.
  CHECK(value("MAX", Shape::circle, sized(at({}, {1, 0, 0}), 5), Shape::point, t) == Approx(30));
  CHECK(value("MAX", Shape::circle, sized(at({}, {0.5, std::sqrt(0.75), 0}), 5), Shape::point, t) ==
        Approx(30 + 5 * std::sqrt(0.75)));
  CHECK(value("MAX", Shape::line, spanning(at({}, {-0.6, 0.8, 0}), -10, 20), Shape::point, t) == Approx(42));
  CHECK(value("MIN", Shape::line, spanning(at({}, {-0.6, 0.8, 0}), -10, 20), Shape::point, t) == Approx(24));
  CHECK(value("MAX", Shape::plane, spread(at({}, {1, 0, 0}), -0.1, 0.2), Shape::point, t) == Approx(30.1));
  CHECK(value("MIN", Shape::plane, spread(at({}, {1, 0, 0}), -0.1, 0.2), Shape::point, t) == Approx(29.8));
}

TEST_CASE("MAX and MIN of slots, rectangles and ellipses go to their outlines") {
  // 40 long and 20 wide, along y; the point lies 100 mm away along x, along y, or between them at 3 : 4.
  Element outline = sized(at({}), 20);
  outline.minor_size = 10, outline.second = {0, 1, 0};
  const auto reach = [&](Shape shape, const Vec3& towards) {
    Evaluation e = nominal_distance("DISTB", "PT2PT", 100, -1, 1).word("use", "MAX");
    return e.feature(shape, outline).feature(Shape::point, at(100 * towards)).value() - 100;
  };
  const Vec3 oblique{0.6, 0.8, 0};
  for (const Shape shape : {Shape::slot, Shape::rectangle, Shape::ellipse}) {
    CHECK(reach(shape, {1, 0, 0}) == Approx(10));
    CHECK(reach(shape, {0, -1, 0}) == Approx(20));
  }
  CHECK(reach(Shape::rectangle, oblique) == Approx(20 * 0.8 + 10 * 0.6));  // to a corner
  CHECK(reach(Shape::ellipse, oblique) == Approx(std::hypot(20 * 0.8, 10 * 0.6)));
  CHECK(reach(Shape::slot, oblique) == Approx(10 * 0.8 + 10));  // the round end: 10 about a centre 10 from the middle
  outline.angle = 1;                                            // flat ends: as a rectangle
  CHECK(reach(Shape::slot, oblique) == Approx(20 * 0.8 + 10 * 0.6));
}

TEST_CASE("MAX and MIN of a torus go round its tube") {
  const auto apart = [](const char* use, const Vec3& axis) {
    Element ring = sized(at({}, axis), 20);
    ring.minor_size = 4;
    return nominal_distance("DISTB", "XAXIS", 50, -1, 1)
        .word("use", use)
        .feature(Shape::torus, ring)
        .feature(Shape::point, at({50, 9, 0}))
        .value();
  };
  CHECK(apart("AVG", {0, 0, 1}) == Approx(50));
  CHECK(apart("MAX", {0, 0, 1}) == Approx(74));
  CHECK(apart("MIN", {0, 0, 1}) == Approx(26));
  CHECK(apart("MAX", {1, 0, 0}) == Approx(54));
  CHECK(apart("MIN", {0.6, 0.8, 0}) == Approx(50 - (20 * 0.8 + 4)));
}

TEST_CASE("MAX and MIN of cylinders and cones go to their rims") {
  const Element bore = sized(spanning(at({0, 0, -4}), -2, 2), 5), other = sized(spanning(at({60, 0, -7}), -2, 2), 5);
  const auto apart_by = [&](const char* axis, const char* use, Shape shape, const Element& a) {
    return nominal_distance("DISTB", axis, 60, -1, 1)
        .word("use", use)
        .feature(shape, a)
        .feature(Shape::cylinder, other)
        .value();
  };
  for (const char* axis : {"XAXIS", "PT2PT"}) {
    CHECK(apart_by(axis, "AVG", Shape::cylinder, bore) == Approx(60));
    CHECK(apart_by(axis, "MAX", Shape::cylinder, bore) == Approx(70));
    CHECK(apart_by(axis, "MIN", Shape::cylinder, bore) == Approx(50));
    CHECK(apart_by(axis, "MAX", Shape::line, bore) == Approx(65));  // the axis alone
  }
  // Leaning by 30 degrees in x: its upper rim reaches 2 sin 30 + 5 cos 30 back, its lower one as far ahead.
  Element leaning_bore = bore;
  leaning_bore.direction = {-0.5, 0, std::sqrt(0.75)};
  CHECK(apart_by("XAXIS", "MAX", Shape::cylinder, leaning_bore) == Approx(60 + 1 + 5 * std::sqrt(0.75) + 5));
  CHECK(apart_by("XAXIS", "MIN", Shape::cylinder, leaning_bore) == Approx(60 - 1 - 5 * std::sqrt(0.75) - 5));
  // A cone of 90 degrees with its apex at z = -9: its radius is 5 + 2 at the upper end.
  Element cone = bore;
  cone.angle = kPi / 4;
  CHECK(apart_by("XAXIS", "MAX", Shape::cone, cone) == Approx(72));
  CHECK(apart_by("XAXIS", "MIN", Shape::cone, cone) == Approx(48));
}

TEST_CASE("DISTWRT measures from its reference") {
  Evaluation e = nominal_distance("DISTWRT", "ZAXIS", 25, -0.1, 0.1);
  e.feature(Shape::sphere, at({1, 2, 3}))
      .feature(Shape::plane, at({0, 0, 28.01}), at({0, 0, 28}));  // the reference comes last
  CHECK(e.value() == Approx(25.01));
  CHECK(e.nominal_value() == 25);
  Evaluation about_zero = nominal_distance("DISTWRT", "YAXIS", 0, -0.1, 0.1);
  about_zero.feature(Shape::sphere, at({1, 2.03, 3})).feature(Shape::plane, at({0, 2, 0}));
  CHECK(about_zero.value() == Approx(0.03));
  Evaluation limit("DISTWRT");
  limit.number("lower", -6)
      .number("upper", -4)
      .word("axis", "YAXIS")
      .feature(Shape::point, at({0, 2, 0}))
      .feature(Shape::point, at({0, 7, 0}));
  CHECK(limit.value() == Approx(-5));
  CHECK(limit.nominal_value() == Approx(-5));
}

namespace {

/// PT2PT of two features that are as their nominals but for what is given.
Evaluation apart(Shape s, const Element& a, Shape t, const Element& b) {
  Evaluation e("DISTB");
  e.number("lower", -1).number("upper", 1).word("axis", "PT2PT").feature(s, a).feature(t, b);
  return e;
}

const Element kFloor = at({50, 50, 0}), kCeiling = at({30, 50, 30}, {0, 0, -1});

/// Turned about y by this angle: z goes to (sin, 0, cos).
Vec3 leaning(double angle) { return {std::sin(angle), 0, std::cos(angle)}; }

}  // namespace

TEST_CASE("A straight distance leaves out what a plane does not determine") {
  CHECK(apart(Shape::plane, kFloor, Shape::plane, kCeiling).value() == Approx(30));
  CHECK(apart(Shape::plane, kFloor, Shape::plane, kCeiling).nominal_value() == Approx(30));
  CHECK(apart(Shape::point, at({0, 0, 30}), Shape::plane, kFloor).value() == Approx(30));
  CHECK(apart(Shape::plane, kFloor, Shape::sphere, at({0, 0, -30})).value() == Approx(30));
  // Of a tilted plane at the point itself: 100 mm beside its centroid a tilt of 0.001 is 0.1 mm.
  CHECK(apart(Shape::plane, at({}, leaning(1e-3)), Shape::point, at({100, 7, 30})).value() ==
        Approx(30.1).epsilon(1e-6));
  // Two planes: midway between their centroids, where one has risen by 10e-3 and the other fallen by as much.
  CHECK(apart(Shape::plane, at({0, 0, 0}, leaning(-1e-3)), Shape::plane, at({20, 0, 30}, leaning(1e-3))).value() ==
        Approx(30).epsilon(1e-6));
  CHECK(apart(Shape::plane, at({0, 0, 0}), Shape::plane, at({20, 0, 30}, leaning(1e-3))).value() ==
        Approx(30 + 10e-3).epsilon(1e-6));
}

TEST_CASE("A straight distance leaves out places along a line or an axis") {
  const Element axis = sized(at({0, 0, -10}), 10), other = sized(at({30, 40, -30}, {0, 0, -1}), 10);
  CHECK(apart(Shape::cylinder, axis, Shape::cylinder, other).value() == Approx(50));
  CHECK(apart(Shape::circle, at({3, 4, 88}), Shape::line, axis).value() == Approx(5));
  CHECK(apart(Shape::plane, at({-5, 70, 3}, {1, 0, 0}), Shape::cylinder, axis).value() == Approx(5));
  // Midway, at z = -20, the leaning axis has come 10 tan a nearer.
  CHECK(apart(Shape::cylinder, axis, Shape::cylinder, at({100, 0, -30}, leaning(-1e-3))).value() ==
        Approx(100 - 10e-3).epsilon(1e-6));
  // Lines that cross: their common perpendicular, wherever their points are.
  CHECK(apart(Shape::line, at({7, 0, 0}, {1, 0, 0}), Shape::line, at({0, -90, 12}, {0, 1, 0})).value() == Approx(12));
  CHECK(apart(Shape::line, at({7, 0, 0}, {1, 0, 0}), Shape::cylinder, at({0, -90, 0}, {0, 1, 0})).value() ==
        Approx(0).scale(1));
}

TEST_CASE("The nominals say what is parallel") {
  const Element tilted = at({0, 0, 40}, leaning(0.1));
  // What meets has no distance of its own: from middle to middle.
  CHECK(apart(Shape::plane, kFloor, Shape::plane, tilted).value() == Approx(std::hypot(50, 50, 40)));
  CHECK(apart(Shape::plane, kFloor, Shape::line, tilted).value() == Approx(std::hypot(50, 50, 40)));
  const auto nominally = [](const Element& nominal) {
    Evaluation e("DISTB");
    e.number("lower", -1).number("upper", 1).word("axis", "PT2PT");
    return e.feature(Shape::line, at({})).feature(Shape::line, at({30, 40, 40}, leaning(1e-3)), nominal);
  };
  CHECK(nominally(at({30, 40, 40})).value() == Approx(std::hypot(30 - 20e-3, 40)).epsilon(1e-6));
  CHECK(nominally(at({30, 40, 40}, leaning(0.1))).value() == Approx(40).epsilon(1e-6));
  Evaluation same("DISTB");
  same.word("axis", "PT2PT").feature(Shape::line, at({})).feature(Shape::line, at({30, 40, 40}), tilted);
  CHECK(same.failure() == "the lines are parallel, and their nominals are not");
}

TEST_CASE("A cone is at its apex") {
  const double angle = kPi / 6;
  Element cone = spanning(sized(at({10, 20, -20}), 20 * std::tan(angle)), -5, 10);  // apex at z = -40
  cone.angle = angle;
  Element nominal = at({10, 20, -40});
  nominal.angle = angle;
  CHECK(apart(Shape::cone, cone, Shape::plane, kFloor).value() == Approx(40));
  CHECK(apart(Shape::cone, cone, Shape::cylinder, at({13, 24, 0})).value() == Approx(5));
  CHECK(
      nominal_distance("DISTB", "ZAXIS", 40, -1, 1).feature(Shape::cone, cone).feature(Shape::point, at({})).value() ==
      Approx(40));
  // MAX and MIN are between measured ends: z from -25 to -10.
  const auto use = [&](const char* which) {
    return nominal_distance("DISTB", "ZAXIS", 40, -1, 1)
        .word("use", which)
        .feature(Shape::cone, cone, nominal)
        .feature(Shape::point, at({}))
        .value();
  };
  CHECK(use("MAX") == Approx(25));
  CHECK(use("MIN") == Approx(10));
}

TEST_CASE("MAX and MIN of a tilted plane are at its outermost touches") {
  // 1 um/mm over 90 mm along x; the second feature brings its own touches.
  const Element bottom = spanning(at({50, 30, 0}), -51, 51), top = spanning(at({50, 30, 20}, leaning(-1e-3)), -51, 51);
  const auto value = [&](const char* axis, const char* use) {
    Evaluation e = nominal_distance("DISTB", axis, 20, -0.1, 0.1)
                       .word("use", use)
                       .feature(Shape::plane, bottom)
                       .feature(Shape::plane, top);
    for (const double x : {5.0, 95.0})
      for (const double y : {5.0, 55.0}) {
        e.touches.push_back({{x, y, 0}, {x, y, 0}, {0, 0, 1}});
        e.second_touches.push_back({{x, y, 20 + 1e-3 * (x - 50)}, {x, y, 20}, {0, 0, 1}});
      }
    return e.value();
  };
  CHECK(value("ZAXIS", "MAX") == Approx(20.045));
  CHECK(value("ZAXIS", "MIN") == Approx(19.955));
  CHECK(value("ZAXIS", "AVG") == Approx(20));
  // Straight: along the mean normal, half of the tilt from both: 22.5 um at the ends of each.
  CHECK(value("PT2PT", "MAX") == Approx(20.045).epsilon(1e-6));
  CHECK(value("PT2PT", "MIN") == Approx(19.955).epsilon(1e-6));
  // Without touches of one face: the tilt over the extent.
  Evaluation made = nominal_distance("DISTB", "ZAXIS", 20, -0.1, 0.1)
                        .word("use", "MAX")
                        .feature(Shape::point, at({}))
                        .feature(Shape::plane, top);
  CHECK(made.value() == Approx(20.051).epsilon(1e-6));
  CHECK(nominal_distance("DISTB", "ZAXIS", 20, -0.1, 0.1)
            .word("use", "MIN")
            .feature(Shape::point, at({}))
            .feature(Shape::plane, top)
            .value() == Approx(19.949).epsilon(1e-6));
  for (const double side : {1.0, -1.0})
    made.second_touches.push_back({{50, 30, 20 + side}, {50, 30, 20 + side}, {0, 0, side}});
  CHECK(made.value() == Approx(20.051).epsilon(1e-6));
}

TEST_CASE("A distance looks at touches where it goes to the ends") {
  CHECK_FALSE(needs_touches(*find_tolerance_kind("DISTB"), nominal_distance("DISTB", "XAXIS", 1, 0, 0).arguments));
  CHECK(needs_touches(*find_tolerance_kind("DISTWRT"),
                      nominal_distance("DISTWRT", "XAXIS", 1, 0, 0).word("use", "MIN").arguments));
}
