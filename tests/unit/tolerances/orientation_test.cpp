#include "tests/unit/tolerances/evaluation.hpp"

using namespace abbe;
using namespace abbe::test;
using doctest::Approx;

namespace {

constexpr double kTilt = 1e-3;
const double kSine = std::sin(kTilt);
const Vec3 kLeaningX{std::sin(kTilt), 0, std::cos(kTilt)};  // z, leaning to x
const Element kUp = at({5, 5, 5}), kAlongX = at({1, 2, 3}, {1, 0, 0}),
              kAlongY = at({1, 2, 3}, {0, 1, 0});

double width(const char* word, Shape shape, const Element& feature, Shape datum_shape,
             const Element& datum, double angle = 0) {
  return Evaluation(word)
      .number("angle", angle)
      .feature(shape, feature)
      .datum(datum_shape, datum)
      .value();
}

}  // namespace

TEST_CASE("Perpendicularity") {
  const Element axis = spanning(at({}, kLeaningX), -10, 40);
  CHECK(width("PERP", Shape::cylinder, axis, Shape::plane, kUp) == Approx(50 * kSine));
  CHECK(width("PERP", Shape::cylinder, axis, Shape::cylinder, kAlongX) == Approx(50 * kSine));
  CHECK(width("PERP", Shape::cylinder, axis, Shape::cylinder, kAlongY) ==
        Approx(0));  // free to lean in the zone of planes
  const Element wall =
      spread(spanning(at({}, {std::cos(kTilt), 0, std::sin(kTilt)}), -30, 30), -0.002, 0.003);
  CHECK(width("PERP", Shape::plane, wall, Shape::plane, kUp) == Approx(60 * kSine + 0.005));
  CHECK(width("PERP", Shape::plane, wall, Shape::line, kAlongX) == Approx(60 * kSine + 0.005));
}

TEST_CASE("Parallelism") {
  const Element top = spread(spanning(at({}, kLeaningX), -30, 30), -0.002, 0.003);
  CHECK(width("PARLEL", Shape::plane, top, Shape::plane, kUp) == Approx(60 * kSine + 0.005));
  CHECK(width("PARLEL", Shape::plane, top, Shape::cylinder, kAlongX) == Approx(60 * kSine + 0.005));
  CHECK(width("PARLEL", Shape::plane, top, Shape::cylinder, kAlongY) == Approx(0.005));
  const Element axis = spanning(at({}, kLeaningX), 0, 50);
  CHECK(width("PARLEL", Shape::cone, axis, Shape::cylinder, kUp) == Approx(50 * kSine));
  CHECK(width("PARLEL", Shape::line, spread(axis, -0.004, 0.004), Shape::plane, kAlongX) ==
        Approx(50 * kSine + 0.008));
}

TEST_CASE("The zone of a measured plane holds its touches") {
  // Touches of a wall 100 long and 20 high that leans by 0.02 over its height; the last is a bump.
  const double lean = std::atan(0.02 / 20), s = std::sin(lean), c = std::cos(lean);
  auto zone = [](const char* word, const Vec3& normal, const Element& datum, Shape shape, std::vector<Vec3> touches, double angle = 0) {
    Evaluation e(word);
    e.number("angle", angle).feature(Shape::plane, spanning(at({}, normal), -51, 51)).datum(shape, datum);
    for (const Vec3& p : touches) e.touches.push_back({p, p, normal});
    return e.value();
  };
  const std::vector<Vec3> wall{{0, 0, 0}, {0, 100, 0}, {-0.02, 0, 20}, {-0.02, 100, 20}, {0, 50, 10}};
  CHECK(zone("PERP", {c, 0, s}, kUp, Shape::plane, wall) == Approx(0.02));
  CHECK(zone("PERP", {-c, 0, -s}, kUp, Shape::plane, wall) == Approx(0.02));  // seen from behind
  // A wall that also turns about the datum's normal: only its lean counts.
  CHECK(zone("PERP", {0.8 * c, 0.6 * c, s}, kUp, Shape::plane, {{0, 0, 0}, {-60, 80, 0}, {-0.016, -0.012, 20}, {-60.016, 79.988, 20}}) == Approx(0.02));
  const std::vector<Vec3> top{{0, 0, 20}, {100, 0, 20.03}, {100, 100, 20.03}, {0, 100, 20}};
  CHECK(zone("PARLEL", {-3e-4, 0, 1}, kUp, Shape::plane, top) == Approx(0.03));
  CHECK(zone("PERP", {-3e-4, 0, 1}, kUp, Shape::cylinder, top) == Approx(0.03));
  CHECK(zone("PARLEL", {-3e-4, 0, 1}, kAlongX, Shape::cylinder, top) == Approx(0.03));
  CHECK(zone("PARLEL", {-3e-4, 0, 1}, kAlongY, Shape::cylinder, top) == Approx(0).epsilon(1e-9));
  // 30 degrees, and 0.02 too much over 40 along the slope.
  const double t = kPi / 6, off = std::asin(0.02 / 40);
  const Vec3 end{40 * std::cos(t + off), 0, -40 * std::sin(t + off)}, n{std::sin(t + off), 0, std::cos(t + off)};
  const std::vector<Vec3> slope{{}, {0, 100, 0}, end, end + Vec3{0, 100, 0}};
  CHECK(zone("ANGLR", n, kUp, Shape::plane, slope, t) == Approx(0.02));
  CHECK(zone("ANGLR", n, kAlongX, Shape::line, slope, t) == Approx(0.02));
}

TEST_CASE("Angularity") {
  auto plane_at = [](double degrees) {
    const double a = degrees * kPi / 180 + kTilt;
    return spanning(at({}, {std::sin(a), 0, std::cos(a)}), -25, 25);
  };
  CHECK(width("ANGLR", Shape::plane, plane_at(30), Shape::plane, kUp, kPi / 6) ==
        Approx(50 * kSine));
  CHECK(width("ANGLR", Shape::plane, plane_at(30), Shape::plane, kUp, 5 * kPi / 6) ==
        Approx(50 * kSine));  // the same angle, seen from behind
  // An axis at 60 degrees to the plane leans by 30 from its normal.
  CHECK(width("ANGLR", Shape::cylinder, plane_at(30), Shape::plane, kUp, kPi / 3) ==
        Approx(50 * kSine));
  CHECK(width("ANGLR", Shape::cylinder, plane_at(30), Shape::line, kUp, kPi / 6) ==
        Approx(50 * kSine));
}

TEST_CASE("Orientations that cannot be evaluated") {
  for (const char* word : {"PERP", "PARLEL", "ANGLR"}) {
    CHECK(Evaluation(word).feature(Shape::circle, kUp).refusal() ==
          "an orientation tolerance is for planes, lines, cylinders and cones");
    CHECK(Evaluation(word).feature(Shape::plane, kUp).refusal().empty());
    CHECK(Evaluation(word).feature(Shape::plane, kUp).datum(Shape::plane, kUp).failure() ==
          "the extent of the feature is not known, so that its orientation has no zone");
    CHECK(Evaluation(word)
              .feature(Shape::plane, spanning(kUp, -1, 1))
              .datum(Shape::point, kUp)
              .failure() == "a point or a sphere is no datum for an orientation");
    CHECK(*Evaluation(word).number("zone", 0.02).feature(Shape::plane, kUp).limits().upper == 0.02);
    CHECK(Evaluation(word).feature(Shape::plane, kUp).nominal_value() == 0);
  }
}

TEST_CASE("ANGL is the full angle of a cone") {
  Element measured = kUp, nominal = kUp;
  measured.angle = 0.301, nominal.angle = 0.3;
  Evaluation e("ANGL");
  e.number("lower", -0.01).number("upper", 0.02).feature(Shape::cone, measured, nominal);
  CHECK(e.value() == Approx(0.602));
  CHECK(e.nominal_value() == Approx(0.6));
  CHECK(*e.limits().lower == Approx(0.59));
  CHECK(*e.limits().upper == Approx(0.62));
  CHECK(unit_of(*e.kind, e.arguments) == Unit::rad);
  CHECK(Evaluation("ANGL").feature(Shape::cylinder, kUp).refusal() ==
        "the angle tolerance of one feature is for cones");
}

TEST_CASE("ANGLB is the angle of two features nearest to the nominal") {
  auto angle = [](double nominal, Shape s, const Element& a, Shape t, const Element& b) {
    Evaluation e("ANGLB");
    return e.number("nominal", nominal)
        .number("lower", -0.01)
        .number("upper", 0.01)
        .feature(s, a)
        .feature(t, b)
        .value();
  };
  const Element at60 = at({}, {0.5, 0, std::sqrt(0.75)});  // 60 degrees from x, 30 from z
  CHECK(angle(kPi / 3, Shape::line, kAlongX, Shape::line, at60) == Approx(kPi / 3));
  CHECK(angle(2 * kPi / 3, Shape::line, kAlongX, Shape::line, at60) == Approx(2 * kPi / 3));
  CHECK(angle(kPi / 6, Shape::plane, kUp, Shape::plane, at60) == Approx(kPi / 6));
  CHECK(angle(kPi / 3, Shape::plane, kUp, Shape::cylinder, at60) == Approx(kPi / 3));
  CHECK(angle(kPi / 2, Shape::plane, kUp, Shape::cylinder, at({}, kLeaningX)) ==
        Approx(kPi / 2 - kTilt));
  Evaluation limit("ANGLB");
  limit.number("lower", 1.9)
      .number("upper", 2.3)
      .feature(Shape::line, kAlongX)
      .feature(Shape::line, at60);
  CHECK(limit.value() == Approx(2 * kPi / 3));
  CHECK(limit.nominal_value() == Approx(2.1));
  CHECK(*limit.limits().lower == 1.9);
  Evaluation nominal("ANGLB");
  nominal.number("nominal", 1).number("lower", -0.1).number("upper", 0.1);
  CHECK(*nominal.limits().upper == Approx(1.1));
  CHECK(Evaluation("ANGLB").feature(Shape::line, kUp).feature(Shape::sphere, kUp).refusal() ==
        "a point or a sphere has no direction to make an angle with");
}

TEST_CASE("The touches of two faces are not those of their median plane") {
  Evaluation e("PARLEL");
  e.feature(Shape::plane, spanning(at({}), -30, 30)).datum(Shape::plane, kUp);
  for (const double side : {5.0, -5.0}) e.touches.push_back({{0, 0, side}, {0, 0, side}, {0, 0, -side / 5}});
  CHECK(e.value() == Approx(0).scale(1));
}

TEST_CASE("A line of a surface adds the straightness of its section") {
  Evaluation e("PARLEL");
  e.feature(Shape::line, spread(spanning(at({}, {1, 0, 0}), -10, 10), -0.007, 0.007)).datum(Shape::plane, kUp);
  for (const double y : {-0.006, 0.004}) e.touches.push_back({{0, 0, y}, {}, {0, 0, 1}});
  CHECK(e.value() == Approx(0.01));
}
