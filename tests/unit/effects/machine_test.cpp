// The effects of the machine: signs, signatures, and sizes that can be worked out by hand.
#include "engine/effects/machine/machine.hpp"

#include "tests/unit/effects/bench.hpp"

namespace abbe {

using namespace effects_test;

namespace {

TouchScene at_reading(const Vec3& reading, const Vec3& normal = {1, 0, 0}) {
  TouchScene scene = touch(normal);
  scene.reading = reading;
  scene.travel_length_mm = {1600, 1000, 800};
  return scene;
}

}  // namespace

TEST_CASE("scale: reads long when positive, on one axis or on all") {
  const TouchScene scene = at_reading({500, 300, -200});
  CHECK(norm(displacement_mm(kMachineScale, scene, {{"scale_um_per_m", 10}}) - Vec3{5e-3, 0, 0}) < 1e-15);
  CHECK(norm(displacement_mm(kMachineScale, scene, {{"scale_um_per_m", 10}, {"axis", 2}}) - Vec3{0, 0, -2e-3}) < 1e-15);
  CHECK(norm(displacement_mm(kMachineScale, scene, {{"scale_um_per_m", 10}, {"axis", 3}}) - 1e-5 * scene.reading) <
        1e-15);
}

TEST_CASE("squareness: an angle above 90 degrees lengthens the diagonal of equal signs") {
  // In a frame of axes that enclose 90 degrees + g a true point p has the readings p + d, to first
  // order.
  const double g = 5e-6, length = 1000 / std::sqrt(2.0);
  const Vec3 d = displacement_mm(kMachineSquareness, at_reading({length, length, 0}), {{"squareness_urad", 5}});
  CHECK(norm(d - Vec3{g * length, 0, 0}) < 1e-15);
  const Vec3 x_axis{1, 0, 0}, y_axis{-std::sin(g), std::cos(g), 0};
  const Vec3 truly = length * x_axis + length * y_axis;
  CHECK(norm(truly + d - Vec3{length, length, 0}) < 1e-7);
  CHECK(dot(unit(truly), d) * 1e3 == doctest::Approx(2.5).epsilon(1e-3));  // 1 m diagonal: g/2 per unit length
  CHECK(norm(displacement_mm(kMachineSquareness, at_reading({7, 8, 100}), {{"squareness_urad", 5}, {"which", 1}}) -
             Vec3{5e-4, 0, 0}) < 1e-15);
  CHECK(norm(displacement_mm(kMachineSquareness, at_reading({7, 8, 100}), {{"squareness_urad", 5}, {"which", 2}}) -
             Vec3{0, 5e-4, 0}) < 1e-15);
}

TEST_CASE("straightness and angle: the angle is the slope of the straightness over the bearing base") {
  std::vector<double> z(static_cast<std::size_t>(kStraightnessAngleCoupling.draws));
  for (std::size_t i = 0; i < z.size(); ++i) z[i] = std::cos(1.0 + 2.0 * static_cast<double>(i));
  for (const int axis : {0, 1, 2}) {
    const auto at = [&](double x, const Vec3& lever, double base) {
      TouchScene scene = at_reading({});
      scene.reading[axis] = x;
      for (Vec3& l : scene.lever_mm) l = lever;
      return displacement_mm(kStraightnessAngleCoupling, scene,
                             {{"amplitude_um", 2}, {"axis", static_cast<double>(axis)}, {"bearing_base_mm", base}}, z);
    };
    const double x = 321, h = 1e-3;
    const Vec3 slope = (at(x + h, {}, 1) - at(x - h, {}, 1)) / (2 * h);
    CHECK(slope[axis] == 0);
    Vec3 along, rotation;
    along[axis] = 1;
    // With a short base the carriage stays square to its rail: w = i x slope.
    rotation = cross(along, slope);
    const Vec3 lever{100, 200, 300};
    CHECK(norm(at(x, lever, 1) - at(x, {}, 1) - cross(rotation, lever)) < 0.01 * norm(cross(rotation, lever)));
    // Exactly, with a long base b: the slope is the difference of the rail at the bearings over b,
    // the offset their mean. Two carriages of base b side by side share a bearing: offset(x + b/2)
    // - offset(x - b/2) = [slope(x + b/2) + slope(x - b/2)] b/2.
    const double b = 300;
    const Vec3 arm = along * 1.0;  // (i x slope) x i = slope
    const auto slope_at = [&](double position) { return at(position, arm, b) - at(position, {}, b); };
    const Vec3 difference = at(x + b / 2, {}, b) - at(x - b / 2, {}, b),
               mean = 0.5 * (slope_at(x + b / 2) + slope_at(x - b / 2));
    CHECK(norm(difference - b * mean) < 1e-12);
    CHECK(norm(difference) > 1e-5);
  }
}

TEST_CASE("straightness and angle: a carriage under the part moves the surface the other way, and turns it alike") {
  // A carriage that carries the part stands at -s when its scale reads s, so the slope against the reading has the
  // other sign than that against the guide: of d = -(e + w x lever) only the first part turns over.
  std::vector<double> z(static_cast<std::size_t>(kStraightnessAngleCoupling.draws));
  for (std::size_t i = 0; i < z.size(); ++i) z[i] = std::cos(1.0 + 2.0 * static_cast<double>(i));
  const auto at = [&](double side, const Vec3& lever) {
    TouchScene scene = at_reading({321, 0, 0});
    scene.side[0] = side, scene.lever_mm[0] = lever;
    return 1e3 * displacement_mm(kStraightnessAngleCoupling, scene, {{"amplitude_um", 2}}, z);
  };
  const Vec3 lever{100, 200, 300};
  CHECK(norm(at(1, {})) > 0.1);
  CHECK(norm(at(1, {}) + at(-1, {})) < 1e-12);
  CHECK(norm((at(1, lever) - at(1, {})) - (at(-1, lever) - at(-1, {}))) < 1e-12);
}

TEST_CASE("straightness and angle: the rail has the rms asked for") {
  double square = 0;
  for (int k = 0; k < kStraightnessAngleCoupling.draws; ++k) {
    std::vector<double> z(static_cast<std::size_t>(kStraightnessAngleCoupling.draws));
    z[static_cast<std::size_t>(k)] = 1;
    const Vec3 d = displacement_mm(kStraightnessAngleCoupling, at_reading({217, 0, 0}),
                                   {{"amplitude_um", 2}, {"bearing_base_mm", 1e-3}}, z);
    square += dot(d, d);
  }
  CHECK(std::sqrt(square / 2) == doctest::Approx(2e-3));  // two directions across the rail
}

TEST_CASE("backlash: half of it in the sense of motion, at once or with memory") {
  TouchScene scene = at_reading({});
  CHECK(displacement_mm(kBacklash, scene, {{"backlash_um", 1.4}}).x == doctest::Approx(0.7e-3));
  scene.sense[0] = -1;
  CHECK(displacement_mm(kBacklash, scene, {{"backlash_um", 1.4}}).x == doctest::Approx(-0.7e-3));
  const auto after = [&](double travel_mm) {
    scene.since_reversal_mm[0] = travel_mm;
    return displacement_mm(kBacklash, scene, {{"backlash_um", 1.4}, {"memory_mm", 2}}).x;
  };
  CHECK(after(0) == doctest::Approx(0.7e-3));  // just turned from + to -: still on the old side
  CHECK(after(2 * std::log(2.0)) == doctest::Approx(0));
  CHECK(after(60) == doctest::Approx(-0.7e-3));
  CHECK(displacement_mm(kBacklash, scene, {{"backlash_um", 1}, {"axis", 1}}).x == 0);
}

TEST_CASE("scale interpolation: repeats with the signal period, two harmonics") {
  const auto at = [](double x_mm, Parameters named) {
    return 1e3 * displacement_mm(kScaleInterpolation, at_reading({x_mm, 0, 0}), named).x;
  };
  const Parameters lida = {{"amplitude_um", 0.2}, {"period_um", 20}};
  CHECK(at(700, lida) == doctest::Approx(0).epsilon(1e-6));
  CHECK(at(700.005, lida) == doctest::Approx(0.2));
  CHECK(at(-699.985, lida) == doctest::Approx(-0.2));
  CHECK(at(3.0023, lida) == doctest::Approx(at(3.0223, lida)));
  CHECK(at(0.0025, {{"second_um", 0.1}}) == doctest::Approx(0.1));
  CHECK(at(0, {{"amplitude_um", 0.2}, {"phase_deg", 90}, {"second_um", 0.1}, {"second_phase_deg", -90}}) ==
        doctest::Approx(0.1));
}

TEST_CASE("dynamics: yaw times arm while accelerating, then ringing that dies") {
  TouchScene scene = at_reading({}, {-1, 0, 0});  // moves along +X
  scene.acceleration_mm_s2 = 1000;
  scene.lever_mm[0] = {0, 500, 0};
  const Parameters yaw = {{"rotation_urad_per_m_s2", 10}};
  CHECK(displacement_mm(kDynamics, scene, yaw).x == doctest::Approx(-5e-3));  // 10 urad x 500 mm
  scene.travel = {1, 0, 0}, scene.normal = {-1, 0, 0};
  scene.settled_s = 1 / 40.0;  // half a period of 20 Hz
  const double zeta = 0.03, decay = std::exp(-kPi * zeta / std::sqrt(1 - zeta * zeta));
  scene.settled_s /= std::sqrt(1 - zeta * zeta);
  CHECK(displacement_mm(kDynamics, scene, yaw).x == doctest::Approx(5e-3 * decay));
  scene.settled_s = 3;
  CHECK(std::fabs(displacement_mm(kDynamics, scene, yaw).x) < 1e-6);
  scene.settled_s = 0;
  scene.travel = {-1, 0, 0};
  CHECK(displacement_mm(kDynamics, scene, yaw).x == doctest::Approx(5e-3));  // the other sense
  scene.travel = {0, 1, 0};
  CHECK(norm(displacement_mm(kDynamics, scene, yaw)) == 0);
}

TEST_CASE("dynamics: what rings begins at rest, however damped") {
  // x'' + 2 zeta w x' + w^2 x = 0 from x = 1, x' = 0: x = 1 - (w t)^2 / 2 + zeta (w t)^3 / 3 - ...
  TouchScene scene = at_reading({}, {-1, 0, 0});
  scene.acceleration_mm_s2 = 1000;
  scene.lever_mm[0] = {0, -1000, 0};
  for (const double zeta : {0.0, 0.3, 0.8}) {
    const auto left = [&](double t) {
      scene.settled_s = t;
      return 1e3 * displacement_mm(kDynamics, scene, {{"rotation_urad_per_m_s2", 1}, {"damping_ratio", zeta}}).x;
    };
    const double t = 1e-4, wt = 2 * kPi * 20 * t;
    CHECK(1 - left(t) == doctest::Approx(wt * wt / 2 - zeta * wt * wt * wt / 3).epsilon(1e-4).scale(0));
  }
}

TEST_CASE("ram droop: third power of the extension; compliance reads in across the ram only") {
  const auto droop = [](double z_mm) {
    return displacement_mm(kRamDroop, at_reading({0, 0, z_mm}), {{"droop_um", 2}});
  };
  CHECK(norm(droop(-800) - Vec3{0, 2e-3, 0}) < 1e-15);
  CHECK(droop(-400).y == doctest::Approx(2e-3 / 8).scale(0));
  CHECK(norm(droop(0)) == 0);
  CHECK(reading_um(kRamDroop, at_reading({0, 0, -800}, {0, -1, 0}), {{"compliance_um", 1}}) == doctest::Approx(-1));
  CHECK(reading_um(kRamDroop, at_reading({0, 0, -800}, {0, 0, 1}), {{"compliance_um", 1}}) == 0);
}

TEST_CASE("map scallops: e'' h^2/8 half-way, nothing at the nodes, as linear interpolation leaves it") {
  const double h = 50,
               curvature = 1e-6;  // of the true error function e = curvature x^2 / 2, in 1/mm
  const double amplitude_um = 1e3 * curvature * h * h / 8;
  for (const double x : {0.0, 12.0, 25.0, 49.0, 110.0}) {
    const double node = h * std::floor(x / h);
    const auto e = [&](double position) { return 0.5 * curvature * position * position; };
    const double interpolated = e(node) + (e(node + h) - e(node)) * (x - node) / h;
    const Vec3 d = displacement_mm(kMapScallops, at_reading({x, 0, 0}), {{"amplitude_um", -amplitude_um}});
    CHECK(d.x == doctest::Approx(e(x) - interpolated).scale(1e-3));
  }
  CHECK(displacement_mm(kMapScallops, at_reading({0, 30, 0}),
                        {{"amplitude_um", 1}, {"axis", 1}, {"direction", 2}, {"node_mm", 5}})
            .z == doctest::Approx(1e-3));
}

TEST_CASE("machine step: from a moment, or from a position on") {
  TouchScene scene = at_reading({900, 0, 0});
  scene.time_s = 599;
  CHECK(norm(displacement_mm(kMachineStep, scene, {{"amplitude_um", 3}, {"t0_s", 600}})) == 0);
  scene.time_s = 600;
  CHECK(norm(displacement_mm(kMachineStep, scene, {{"amplitude_um", 3}, {"t0_s", 600}, {"direction", 1}}) -
             Vec3{0, 3e-3, 0}) < 1e-15);
  CHECK(norm(displacement_mm(kMachineStep, scene,
                             {{"amplitude_um", 3}, {"direction", 2}, {"along", 1}, {"position_mm", 901}})) == 0);
  CHECK(norm(displacement_mm(kMachineStep, scene,
                             {{"amplitude_um", 3}, {"direction", 2}, {"along", 1}, {"position_mm", 900}}) -
             Vec3{0, 0, 3e-3}) < 1e-15);
  CHECK(norm(displacement_mm(kMachineStep, scene, {{"amplitude_um", 3}, {"direction", 3}, {"azimuth_deg", 180}}) -
             Vec3{-3e-3, 0, 0}) < 1e-15);
}

}  // namespace abbe
