#include "tests/unit/tolerances/evaluation.hpp"

using namespace abbe;
using namespace abbe::test;
using doctest::Approx;

namespace {

constexpr double kTilt = 1e-3;
const double kSine = std::sin(kTilt);
const Vec3 kLeaningX{std::sin(kTilt), 0, std::cos(kTilt)};  // z, leaning to x
const Element kUp = at({5, 5, 5}), kAlongX = at({1, 2, 3}, {1, 0, 0}), kAlongY = at({1, 2, 3}, {0, 1, 0});

double width(const char* word, Shape shape, const Element& feature, Shape datum_shape, const Element& datum,
             double angle = 0) {
  return Evaluation(word).number("angle", angle).feature(shape, feature).datum(datum_shape, datum).value();
}

}  // namespace

TEST_CASE("Perpendicularity") {
  const Element axis = spanning(at({}, kLeaningX), -10, 40);
  CHECK(width("PERP", Shape::cylinder, axis, Shape::plane, kUp) == Approx(50 * kSine));
  CHECK(width("PERP", Shape::cylinder, axis, Shape::cylinder, kAlongX) == Approx(50 * kSine));
  CHECK(width("PERP", Shape::cylinder, axis, Shape::cylinder, kAlongY) ==
        Approx(0));  // free to lean in the zone of planes
  const Element wall = spread(spanning(at({}, {std::cos(kTilt), 0, std::sin(kTilt)}), -30, 30), -0.002, 0.003);
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
  CHECK(width("PARLEL", Shape::line, spread(axis, -0.004, 0.004), Shape::plane, kAlongX) == Approx(50 * kSine + 0.008));
}

TEST_CASE("The zone of a measured plane holds its touches") {
  // Touches of a wall 100 long and 20 high that leans by 0.02 over its height; the last is a bump.
  const double lean = std::atan(0.02 / 20), s = std::sin(lean), c = std::cos(lean);
  auto zone = [](const char* word, const Vec3& normal, const Element& datum, Shape shape, std::vector<Vec3> touches,
                 double angle = 0) {
    Evaluation e(word);
    e.number("angle", angle).feature(Shape::plane, spanning(at({}, normal), -51, 51)).datum(shape, datum);
    for (const Vec3& p : touches) e.touches.push_back({p, p, normal});
    return e.value();
  };
  const std::vector<Vec3> wall{{0, 0, 0}, {0, 100, 0}, {-0.02, 0, 20}, {-0.02, 100, 20}, {0, 50, 10}};
  CHECK(zone("PERP", {c, 0, s}, kUp, Shape::plane, wall) == Approx(0.02));
  CHECK(zone("PERP", {-c, 0, -s}, kUp, Shape::plane, wall) == Approx(0.02));  // seen from behind
  // A wall that also turns about the datum's normal: only its lean counts.
  CHECK(zone("PERP", {0.8 * c, 0.6 * c, s}, kUp, Shape::plane,
             {{0, 0, 0}, {-60, 80, 0}, {-0.016, -0.012, 20}, {-60.016, 79.988, 20}}) == Approx(0.02));
  const std::vector<Vec3> top{{0, 0, 20}, {100, 0, 20.03}, {100, 100, 20.03}, {0, 100, 20}};
  CHECK(zone("PARLEL", {-3e-4, 0, 1}, kUp, Shape::plane, top) == Approx(0.03));
  CHECK(zone("PERP", {-3e-4, 0, 1}, kUp, Shape::cylinder, top) == Approx(0.03));
  // One that lies exactly along the datum does not stand on it, and is not flawless for having no side to lean to.
  const std::vector<Vec3> level{{0, 0, 20}, {100, 0, 20}, {100, 100, 20}, {0, 100, 20}};
  CHECK(zone("PERP", {0, 0, 1}, kUp, Shape::plane, level) > 99);
  CHECK(zone("ANGLR", {0, 0, 1}, kUp, Shape::plane, level, kPi / 6) > 49);
  CHECK(zone("PARLEL", {0, 0, 1}, kUp, Shape::plane, level) == 0);
  CHECK(zone("PARLEL", {-3e-4, 0, 1}, kAlongX, Shape::cylinder, top) == Approx(0.03));
  CHECK(zone("PARLEL", {-3e-4, 0, 1}, kAlongY, Shape::cylinder, top) == Approx(0).epsilon(1e-9));
  // 30 degrees, and 0.02 too much over 40 along the slope.
  const double t = kPi / 6, off = std::asin(0.02 / 40);
  const Vec3 end{40 * std::cos(t + off), 0, -40 * std::sin(t + off)}, n{std::sin(t + off), 0, std::cos(t + off)};
  const std::vector<Vec3> slope{{}, {0, 100, 0}, end, end + Vec3{0, 100, 0}};
  CHECK(zone("ANGLR", n, kUp, Shape::plane, slope, t) == Approx(0.02));
  CHECK(zone("ANGLR", n, kAlongX, Shape::line, slope, t) == Approx(0.02));
}

TEST_CASE("A line of a surface that runs across what is asked has a zone as long as it is") {
  // Along x on a face whose normal is -y: in a section of z and y it is a point.
  const auto zone = [](const char* word, Shape shape, const Vec3& direction) {
    Evaluation e(word);
    e.feature(Shape::line, spanning(at({50, 0, -5}, direction), -45, 45)).datum(shape, kUp);
    for (const double t : {-45.0, 0.0, 45.0}) {
      const Vec3 p = Vec3{50, 0, -5} + t * direction;
      e.touches.push_back({p, p, {0, -1, 0}});
    }
    return e.value();
  };
  CHECK(zone("PARLEL", Shape::cylinder, {1, 0, 0}) == Approx(90));
  CHECK(zone("PERP", Shape::plane, {1, 0, 0}) == Approx(90));
  CHECK(zone("PARLEL", Shape::cylinder, {0, 0, 1}) == Approx(0).epsilon(1e-9));
  // Leaning in the face is where the program put the touches; leaning out of it is the deviation.
  CHECK(zone("PERP", Shape::plane, {0.1, 0, std::sqrt(0.99)}) == Approx(0).epsilon(1e-9));
  CHECK(zone("PERP", Shape::plane, {0, 0.01, std::sqrt(0.9999)}) == Approx(0.9));
  CHECK(zone("PARLEL", Shape::plane, {0, 0, 1}) == Approx(90));
}

TEST_CASE("Angularity") {
  auto plane_at = [](double degrees) {
    const double a = degrees * kPi / 180 + kTilt;
    return spanning(at({}, {std::sin(a), 0, std::cos(a)}), -25, 25);
  };
  CHECK(width("ANGLR", Shape::plane, plane_at(30), Shape::plane, kUp, kPi / 6) == Approx(50 * kSine));
  CHECK(width("ANGLR", Shape::plane, plane_at(30), Shape::plane, kUp, 5 * kPi / 6) ==
        Approx(50 * kSine));  // the same angle, seen from behind
  // An axis at 60 degrees to the plane leans by 30 from its normal.
  CHECK(width("ANGLR", Shape::cylinder, plane_at(30), Shape::plane, kUp, kPi / 3) == Approx(50 * kSine));
  CHECK(width("ANGLR", Shape::cylinder, plane_at(30), Shape::line, kUp, kPi / 6) == Approx(50 * kSine));
}

TEST_CASE("Orientations that cannot be evaluated") {
  for (const char* word : {"PERP", "PARLEL", "ANGLR"}) {
    CHECK(Evaluation(word).feature(Shape::circle, kUp).refusal() ==
          "an orientation tolerance is for planes, lines, cylinders and cones");
    CHECK(Evaluation(word).feature(Shape::plane, kUp).refusal().empty());
    CHECK(Evaluation(word).feature(Shape::plane, kUp).datum(Shape::plane, kUp).failure() ==
          "the extent of the feature is not known, so that it has no zone");
    CHECK(Evaluation(word).feature(Shape::plane, spanning(kUp, -1, 1)).datum(Shape::point, kUp).failure() ==
          "a point or a sphere is no datum for an orientation");
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
  CHECK(angle(kPi / 2, Shape::plane, kUp, Shape::cylinder, at({}, kLeaningX)) == Approx(kPi / 2 - kTilt));
  Evaluation limit("ANGLB");
  limit.number("lower", 1.9).number("upper", 2.3).feature(Shape::line, kAlongX).feature(Shape::line, at60);
  CHECK(limit.value() == Approx(2 * kPi / 3));
  CHECK(limit.nominal_value() == Approx(2.1));
  CHECK(*limit.limits().lower == 1.9);
  Evaluation nominal("ANGLB");
  nominal.number("nominal", 1).number("lower", -0.1).number("upper", 0.1);
  CHECK(*nominal.limits().upper == Approx(1.1));
  CHECK(Evaluation("ANGLB").feature(Shape::line, kUp).feature(Shape::sphere, kUp).refusal() ==
        "a point or a sphere has no direction to make an angle with");
}

TEST_CASE("ANGLWRT is the angle with its reference") {
  const auto of = [](const Element& reference) {
    Evaluation e("ANGLWRT");
    return e.number("nominal", kPi / 2)
        .number("lower", -0.01)
        .number("upper", 0.01)
        .feature(Shape::plane, kUp)
        .feature(Shape::line, reference, at({}, {0, 0, 1}));
  };
  CHECK(of(at({}, kLeaningX)).value() == Approx(kPi / 2 - kTilt));
  CHECK(*of(kUp).limits().upper == Approx(kPi / 2 + 0.01));
  CHECK(Evaluation("ANGLWRT").feature(Shape::line, kUp).feature(Shape::point, kUp).refusal() ==
        "a point or a sphere has no direction to make an angle with");
}

TEST_CASE("The side of an angle of 90 degrees is that of the nominals, on every machine alike") {
  const double tilt = 1e-3;
  // A plane that leans by `by` against one along x, and the same with its normal reported the other way round.
  const auto found = [&](double by, double turned, double lower, double upper) {
    Evaluation e("ANGLB");
    return e.number("lower", lower)
        .number("upper", upper)
        .feature(Shape::plane, kUp)
        .feature(Shape::plane, at({}, turned * Vec3{std::cos(by), 0, -std::sin(by)}), kAlongX)
        .value();
  };
  for (const double turned : {1.0, -1.0})
    for (const auto& [lower, upper] :
         {std::pair{kPi / 2, kPi / 2 + 0.1}, {kPi / 2 - 0.1, kPi / 2}, {kPi / 2 - 0.1, kPi / 2 + 0.1}}) {
      CHECK(found(tilt, turned, lower, upper) == Approx(kPi / 2 + tilt).epsilon(1e-12));
      CHECK(found(-tilt, turned, lower, upper) == Approx(kPi / 2 - tilt).epsilon(1e-12));
    }
}

TEST_CASE("An angle comes as its nominal is written") {
  const Element at60 = at({}, {0.5, 0, std::sqrt(0.75)}),
                at61 = at({}, {std::cos(61 * kPi / 180), 0, std::sin(61 * kPi / 180)});
  for (const auto& [nominal, expected] :
       {std::pair{60.0, 61.0}, {-60.0, -61.0}, {300.0, 299.0}, {420.0, 421.0}, {240.0, 241.0}, {120.0, 119.0}}) {
    Evaluation e("ANGLB");
    e.number("nominal", nominal * kPi / 180).feature(Shape::line, kAlongX).feature(Shape::line, at61, at60);
    CHECK(e.value() * 180 / kPi == Approx(expected));
  }
}

TEST_CASE("The zone of a median plane holds the touches of its faces where they lie on it") {
  // A slot 10 wide, 100 long and 10 deep whose median plane leans by 0.01 over its depth: the zone is 0.01
  // wide, and not 0.1, which it would be of a disc as long as the slot.
  const Vec3 normal = unit({1, 0, -1e-3});
  for (const char* word : {"PARLEL", "PERP"}) {
    Evaluation e(word);
    const bool parallel = e.kind->word == "PARLEL";
    e.feature(Shape::plane, spanning(at({}, normal), -50, 50))
        .datum(Shape::plane, parallel ? at({}, {1, 0, 0}) : at({}));
    for (const double side : {5.0, -5.0})
      for (const double y : {-50.0, 50.0})
        for (const double z : {-5.0, 5.0}) e.faces.push_back(Vec3{1e-3 * z, y, z} + side * normal);
    CHECK(e.value() == Approx(0.01).epsilon(1e-5));
  }
}

TEST_CASE("The zone of a measured line holds its touches") {
  auto zone = [](const char* word, const Vec3& along, const Vec3& normal, const Element& datum, Shape shape,
                 std::vector<Vec3> touches, double angle = 0) {
    Evaluation e(word);
    e.number("angle", angle).feature(Shape::line, spread(spanning(at({}, along), -20, 20), -1, 1)).datum(shape, datum);
    for (const Vec3& p : touches) e.touches.push_back({p, p, normal});
    return e.value();
  };
  // Heights 0, 4, 12, 12 and 12 um: least squares put the line at a slope of 0.32 um/mm, but planes 12 um
  // apart hold the touches.
  const std::vector<Vec3> heights{{0, -20, 0}, {0, -10, 0.004}, {0, 0, 0.012}, {0, 10, 0.012}, {0, 20, 0.012}};
  const Vec3 rising = {0, 1, 3.2e-4}, up{0, 0, 1};
  CHECK(zone("PARLEL", rising, up, kUp, Shape::plane, heights) == Approx(0.012));
  CHECK(zone("PERP", rising, up, kUp, Shape::cylinder, heights) == Approx(0.012));
  // Along an axis, in the section of the surface; and across a plane.
  CHECK(zone("PARLEL", rising, up, kAlongY, Shape::cylinder, heights) == Approx(0.012));
  CHECK(zone("PERP", rising, up, kAlongY, Shape::plane, heights) == Approx(0.012));
  // Sideways it is nominal, but a surface along the datum's normal is no section: a cylinder about the middle
  // (0, 0, 0) of the line.
  CHECK(zone("PARLEL", rising, {0, 1, 0}, kAlongY, Shape::cylinder, heights) == Approx(0.024));
  // The middle of the line is that of its ends, wherever its point is: from (0, 10, 0), rising by 1e-3, it is 0.01 up.
  Evaluation rod("PARLEL");
  rod.feature(Shape::line, spanning(at({0, 10, 0.01}, {0, 1, 1e-3}), -30, 10)).datum(Shape::line, kAlongY);
  for (const double y : {-20.0, 20.0}) rod.touches.push_back({{0, y, 1e-3 * y}, {0, y, 0}, {y, 0, 1}});
  CHECK(rod.value() == Approx(0.04).epsilon(1e-5));
  // 30 degrees to the plane, on a slope; the touches lie 0, 3, -1 um beside it.
  const double c = std::cos(kPi / 6), s = 0.5;
  const std::vector<Vec3> slope{{0, 0, 0}, {-0.003 * s, 0, 0.003 * c}, {20 * c + 0.001 * s, 0, 20 * s - 0.001 * c}};
  CHECK(zone("ANGLR", {c, 0, s}, {-s, 0, c}, kUp, Shape::plane, slope, kPi / 6) == Approx(0.004));
}
