// The empirical effects: what they interpolate, worked out by hand.
#include "engine/effects/empirical/empirical.hpp"

#include "tests/unit/effects/bench.hpp"

namespace abbe {

using namespace effects_test;

namespace {

/// Of a touch whose normal is z.
Vec3 um(const Effect& effect, const TouchScene& scene, Parameters named) {
  return 1e3 * displacement_mm(effect, scene, named);
}

}  // namespace

TEST_CASE("curve: linear between its knots, constant beyond the ends, in W and along the normal") {
  // Knots every 100 s from 0 to 1500 s.
  const Parameters curve = {{"from", 0},  {"to", 1500},  {"x0_um", 7},  {"x3_um", 2},
                            {"x4_um", 4}, {"r4_um", 10}, {"y15_um", 5}, {"z4_um", -2}};
  const auto at = [&](double time_s) {
    TouchScene scene = touch({0, 0, 1});
    scene.time_s = time_s;
    return um(kEmpiricalCurve, scene, curve);
  };
  CHECK(norm(at(400) - Vec3{4, 0, 8}) < 1e-12);
  CHECK(norm(at(325) - Vec3{2.5, 0, 2}) < 1e-12);
  CHECK(norm(at(1475) - Vec3{0, 3.75, 0}) < 1e-12);
  CHECK(norm(at(9999) - Vec3{0, 5, 0}) < 1e-12);
  CHECK(norm(at(-50) - Vec3{7, 0, 0}) < 1e-12);
}

TEST_CASE("map: linear between its nodes along the two coordinates of its plane, each in its order") {
  // In x and z: nodes every 100 mm from 0 to 500 and every 20 mm from -100 to 0.
  const Parameters map = {{"plane", 1}, {"from_1", 0},   {"to_1", 500},   {"from_2", -100},
                          {"to_2", 0},  {"y_1_3_um", 8}, {"r_2_3_um", 4}, {"x_5_5_um", 6}};
  const auto at = [&](double x, double z) {
    TouchScene scene = touch({0, 0, 1});
    scene.point = {x, 777, z};
    return um(kEmpiricalMap, scene, map);
  };
  CHECK(norm(at(100, -40) - Vec3{0, 8, 0}) < 1e-12);
  CHECK(norm(at(300, -80)) < 1e-12);  // node 3 of x and 1 of z
  CHECK(norm(at(200, -40) - Vec3{0, 0, 4}) < 1e-12);
  CHECK(norm(at(150, -45) - Vec3{0, 3, 1.5}) < 1e-12);  // half of 3/4 of each
  CHECK(norm(at(900, 50) - Vec3{6, 0, 0}) < 1e-12);
}

TEST_CASE("direction: products of the normal's components, seen from the machine or from the probe") {
  const double s = std::sqrt(0.5);
  CHECK(reading_um(kEmpiricalDirection, touch({0.6, 0, 0.8}), {{"xxz_um", 10}}) == doctest::Approx(2.88));
  CHECK(reading_um(kEmpiricalDirection, touch({0, -s, s}), {{"yyyz_um", 8}}) == doctest::Approx(-2));
  // A = B = 90 degrees: the last link's x points up, its z along -y.
  const TouchScene turned = touch({0, -0.6, 0.8}, 50, kPi / 2, kPi / 2);
  CHECK(reading_um(kEmpiricalDirection, turned, {{"frame", 1}, {"xxz_um", 10}}) == doctest::Approx(10 * 0.64 * 0.6));
}

TEST_CASE("offset: of one stylus, or of one orientation, by both of its angles") {
  TouchScene scene = touch({0, 0, 1}, 50, kPi / 2, kPi / 6);
  scene.stylus.ordinal = 2;
  const auto of_stylus = [&](double sensor) {
    return um(kEmpiricalOffset, scene, {{"sensor", sensor}, {"x_um", 1}, {"y_um", -2}, {"z_um", 3}, {"r_um", 10}});
  };
  CHECK(norm(of_stylus(2) - Vec3{1, -2, 13}) < 1e-12);
  CHECK(norm(of_stylus(1)) == 0);
  const auto of_orientation = [&](double a, double b) {
    return um(kEmpiricalOffset, scene, {{"of", 1}, {"head_A_deg", a}, {"head_B_deg", b}, {"x_um", 1}}).x;
  };
  CHECK(of_orientation(90, 30) == doctest::Approx(1));
  CHECK(of_orientation(90, 90) == 0);
  CHECK(of_orientation(30, 30) == 0);
}

}  // namespace abbe
