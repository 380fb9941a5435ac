#include <array>

#include "tests/unit/tolerances/evaluation.hpp"

using namespace abbe;
using namespace abbe::test;
using doctest::Approx;

namespace {

Evaluation position(const char* space, double zone = 0.1) {
  Evaluation e("POS");
  e.word("space", space).number("zone", zone);
  return e;
}

const Element kTop = at({40, 30, 0}), kSide = at({0, 10, -5}, {-1, 0, 0}), kFront = at({25, 0, -5}, {0, -1, 0});

}  // namespace

TEST_CASE("Position in space and in the plane across the nominal direction") {
  const Element nominal = at({10, 20, 30}), actual = at({10.03, 20.04, 30.12});
  CHECK(position("3D").feature(Shape::point, actual, nominal).value() == Approx(0.26));
  CHECK(position("3D").feature(Shape::circle, actual, nominal).value() == Approx(0.26));
  CHECK(position("2D").feature(Shape::circle, actual, nominal).value() == Approx(0.10));
  const Element along_y = at({10, 20, 30}, {0, 1, 0});
  CHECK(position("2D").feature(Shape::cylinder, at({10.03, 25, 30.04}, {0, 1, 0}), along_y).value() == Approx(0.10));
  CHECK(position("2D").feature(Shape::sphere, actual, along_y).value() ==
        Approx(0.10));  // a sphere has no direction: z
}

TEST_CASE("An axis is out of position by its worse end") {
  const Element nominal = at({10, 20, 0});
  const double tilt = 1e-3;
  const Element straight = spanning(at({10.03, 20.04, -9}), -10, 10);
  CHECK(position("3D").feature(Shape::cylinder, straight, nominal).value() == Approx(0.10));
  // 0.02 off at the point, and turned by 1e-3 the same way: 0.02 + 15e-3 at the far end.
  const Element tilted = spanning(at({10.02, 20, 5}, {std::sin(tilt), 0, std::cos(tilt)}), -10, 15);
  CHECK(position("3D").feature(Shape::cylinder, tilted, nominal).value() == Approx(2 * (0.02 + 15 * std::sin(tilt))));
  CHECK(position("2D").feature(Shape::cylinder, tilted, nominal).value() == Approx(2 * (0.02 + 15 * std::sin(tilt))));
  CHECK(position("2D").feature(Shape::torus, tilted, nominal).value() == Approx(0.04));  // a centre
}

TEST_CASE("A plane is out of position by its worst corner") {
  const Element nominal = at({0, 0, 50});
  CHECK(position("3D")
            .feature(Shape::plane, spread(spanning(at({7, 8, 50.02}), -9, 9), -0.001, 0.005), nominal)
            .value() == Approx(0.05));
  CHECK(position("3D")
            .feature(Shape::plane, spread(spanning(at({7, 8, 49.98}), -9, 9), -0.001, 0.005), nominal)
            .value() == Approx(0.042));
  const Element tilted = spanning(at({0, 0, 50.01}, {1e-3, 0, 1}), -20, 20);
  CHECK(position("3D").feature(Shape::plane, tilted, nominal).value() == Approx(0.06).epsilon(1e-5));
  CHECK(position("3D").feature(Shape::plane, at({0, 0, 50.01}), nominal).failure() ==
        "the extent of the feature is not known, so that it has no zone");
  // Touched over 100 x 20 mm, 5 um low along one long side and 5 um high along the other: the zone of +-5 um holds it.
  Evaluation touched = position("3D");
  touched.feature(Shape::plane, spanning(at({0, 0, 50}, {0, -5e-4, 1}), -51, 51), nominal);
  for (const double x : {-50.0, 50.0})
    for (const double y : {-10.0, 10.0}) touched.touches.push_back({{x, y, 50 + 5e-4 * y}, {x, y, 50}, {0, 0, 1}});
  CHECK(touched.value() == Approx(0.010));
  CHECK(position("2D").feature(Shape::plane, nominal).refusal() == "the position of a plane is written 3D");
}

TEST_CASE("Datums carry the frame of the position") {
  const Element nominal = sized(at({60, 40, -10}), 8);
  SUBCASE("a part that lies elsewhere is in position all the same") {
    const Rigid moved{rotation(unit({1, -2, 0.5}), 0.01), {0.3, -0.2, 0.5}};
    const double value = position("3D")
                             .feature(Shape::sphere, moved * nominal, nominal)
                             .datum(Shape::plane, moved * kTop, kTop)
                             .datum(Shape::plane, moved * kSide, kSide)
                             .datum(Shape::plane, moved * kFront, kFront)
                             .value();
    CHECK(value < 1e-12);
    CHECK(position("3D").feature(Shape::sphere, moved * nominal, nominal).value() > 0.5);
  }
  SUBCASE("an error of a datum becomes an error of position") {
    const Element side_too_far = at({0.02, 10, -5}, {-1, 0, 0});
    CHECK(position("3D")
              .feature(Shape::sphere, nominal)
              .datum(Shape::plane, kTop)
              .datum(Shape::plane, side_too_far, kSide)
              .datum(Shape::plane, kFront)
              .value() == Approx(0.04));
    // A primary tilted by 1e-4 about y through its centroid turns the sphere by 1e-4 (x and z from
    // where the datums cross).
    const Element tilted_top = at({40, 30, 0}, {1e-4, 0, 1});
    const double dz = 1e-4 * (60 - 40), dx = 1e-4 * (-10 - -5);
    CHECK(position("3D")
              .feature(Shape::sphere, nominal)
              .datum(Shape::plane, tilted_top, kTop)
              .datum(Shape::plane, kSide)
              .datum(Shape::plane, kFront)
              .value() == Approx(2 * std::hypot(dz, dx)).epsilon(1e-3).scale(0));
  }
  SUBCASE("freedoms without a datum are those of the coordinate system") {
    CHECK(position("3D")
              .feature(Shape::sphere, at({60, 40, -9.99}), nominal)
              .datum(Shape::plane, at({40, 30, 0.01}), kTop)
              .value() == Approx(0).scale(1));
    CHECK(position("3D").feature(Shape::sphere, at({60.02, 40, -10}), nominal).datum(Shape::plane, kTop).value() ==
          Approx(0.04));
  }
  CHECK(position("3D")
            .feature(Shape::sphere, nominal)
            .datum(Shape::plane, kTop)
            .datum(Shape::plane, kTop)
            .datum(Shape::plane, kTop)
            .datum(Shape::plane, kTop)
            .refusal() == "a position has at most three datums");
}

TEST_CASE("Limits of a position") {
  CHECK(*position("3D", 0.1).feature(Shape::point, at({})).limits().upper == 0.1);
  CHECK_FALSE(position("2D", 0).feature(Shape::point, at({})).limits().upper);
  // Without the size tolerance there is no bonus to give.
  CHECK(*position("3D", 0.1)
             .word("material", "MMC")
             .feature(Shape::cylinder, sized(at({}), 8.1), sized(at({}), 8))
             .limits()
             .upper == 0.1);
  CHECK(position("3D", 0.1).feature(Shape::point, at({})).nominal_value() == 0);
}

TEST_CASE("CORTOL reports deviations of coordinates") {
  auto deviation = [](const char* axis) {
    Evaluation e("CORTOL");
    e.word("axis", axis)
        .number("lower", -0.1)
        .number("upper", 0.2)
        .feature(Shape::circle, at({3.01, 3.98, 7.5}), at({3, 4, 7}));
    return e;
  };
  CHECK(deviation("XAXIS").value() == Approx(0.01));
  CHECK(deviation("YAXIS").value() == Approx(-0.02));
  CHECK(deviation("ZAXIS").value() == Approx(0.5));
  CHECK(deviation("RADIUS").value() == Approx(std::hypot(3.01, 3.98) - 5));
  CHECK(deviation("ANGLE").value() == Approx(std::atan2(3.98, 3.01) - std::atan2(4, 3)));
  CHECK(*deviation("XAXIS").limits().lower == -0.1);
  CHECK(*deviation("XAXIS").limits().upper == 0.2);
  CHECK(deviation("XAXIS").nominal_value() == 0);
  CHECK(unit_of(*deviation("ANGLE").kind, deviation("ANGLE").arguments) == Unit::rad);
  CHECK(unit_of(*deviation("RADIUS").kind, deviation("RADIUS").arguments) == Unit::mm);
  CHECK(deviation("XAXIS").refusal().empty());
}

TEST_CASE("A polar angle does not jump at half a turn, and needs a radius") {
  Evaluation e("CORTOL");
  e.word("axis", "ANGLE").feature(Shape::point, at({-10, -0.01, 0}), at({-10, 0.01, 0}));
  CHECK(e.value() == Approx(2 * std::atan(1e-3)));
  Evaluation none("CORTOL");
  none.word("axis", "ANGLE").feature(Shape::point, at({0, 0, 4}), at({1, 0, 4}));
  CHECK(none.failure() == "a point on the z axis has no polar angle");
}

namespace {

Vec3 deviations(Shape shape, const Element& actual, const Element& nominal) {
  Vec3 made;
  for (int k = 0; k < 3; ++k) {
    Evaluation e("CORTOL");
    made[k] = e.word("axis", std::array{"XAXIS", "YAXIS", "ZAXIS"}[static_cast<std::size_t>(k)])
                  .feature(shape, actual, nominal)
                  .value();
  }
  return made;
}

void check_deviations(const Vec3& is, const Vec3& expected) {
  CAPTURE(is.x);
  CAPTURE(is.y);
  CAPTURE(is.z);
  CHECK(norm(is - expected) < 1e-9);
}

}  // namespace

TEST_CASE("CORTOL compares where a plane, line or axis passes the nominal point") {
  const Vec3 slope = unit({1, 0, std::sqrt(3.0)}), along = unit({std::sqrt(3.0), 0, -1});
  check_deviations(deviations(Shape::plane, at(25 * along + Vec3{0, 25, 0}, slope), at({}, slope)), {});
  check_deviations(deviations(Shape::plane, at(25 * along + 0.02 * slope, slope), at({}, slope)), 0.02 * slope);
  check_deviations(deviations(Shape::plane, at({40, 30, 0.02}), at({50, 50, 0})), {0, 0, 0.02});  // square to an axis
  check_deviations(deviations(Shape::line, at({50 + 9 * along.x, 0.03, 9 * along.z}, along), at({50, 0, 0}, along)),
                   {0, 0.03, 0});
  check_deviations(deviations(Shape::cylinder, at({3.01, 3.98, -15}), at({3, 4, 0})), {0.01, -0.02, 0});
  // The axis leans: at the nominal height it is 10 mm above its own point.
  const Vec3 d = unit({1e-3, 0, 1});
  const double t = 10 / d.z;
  check_deviations(deviations(Shape::cylinder, at(Vec3{3, 4, 0} - t * d, d), at({3, 4, 0})), {});
}

TEST_CASE("CORTOL of a cone compares its apex") {
  Element nominal = at({100, 50, -40});
  nominal.angle = kPi / 6;
  Element cone = sized(at({100, 50, -15.1}), 25 * std::tan(kPi / 6));
  cone.angle = kPi / 6;
  check_deviations(deviations(Shape::cone, cone, nominal), {0, 0, -0.1});
}
