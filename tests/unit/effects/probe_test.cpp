// The effects of the probe against published magnitudes, their signs and their signatures.
#include "engine/effects/probe/probe.hpp"

#include "tests/unit/effects/bench.hpp"

namespace abbe {

using namespace effects_test;

namespace {

Vec3 horizontal(double azimuth_rad) { return {std::cos(azimuth_rad), std::sin(azimuth_rad), 0}; }

/// Amplitude of harmonic m of the readings round the equator, um.
double harmonic(int m, double length_mm, Parameters named) {
  constexpr int kPoints = 7200;
  double sum = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double azimuth = 2 * kPi * i / kPoints;
    sum += reading_um(kPretravelLobing, touch(horizontal(azimuth), length_mm), named) * std::cos(m * azimuth);
  }
  return (m == 0 ? 1 : 2) * sum / kPoints;
}

/// Integral of f(n) over the hemisphere towards the head, divided by its area.
template <class F>
double mean_over_hemisphere(F f, int rings = 120, int sectors = 120) {
  double sum = 0;
  for (int i = 0; i < rings; ++i) {
    const double z = (i + 0.5) / rings, across = std::sqrt(1 - z * z);
    for (int j = 0; j < sectors; ++j) {
      const double azimuth = 2 * kPi * (j + 0.5) / sectors;
      sum += f(Vec3{across * std::cos(azimuth), across * std::sin(azimuth), z});
    }
  }
  return sum / (rings * sectors);
}

}  // namespace

TEST_CASE("pretravel: harmonics of the tripod's statics round the equator") {
  // A pole touch shows minus the mean that the qualification stored, so the pretravel itself is
  // pole minus equator.
  const double pole = reading_um(kPretravelLobing, touch({0, 0, 1}), {{"amplitude_um", 1}});
  const double mean = pole - harmonic(0, 50, {{"amplitude_um", 1}});
  CHECK(mean == doctest::Approx(2 * 1.2576).epsilon(1e-3));
  CHECK(-harmonic(3, 50, {{"amplitude_um", 1}}) / mean == doctest::Approx(-0.275).epsilon(0.002).scale(0));
  CHECK(-harmonic(6, 50, {{"amplitude_um", 1}}) / mean == doctest::Approx(0.104).epsilon(0.005).scale(0));
  CHECK(-harmonic(9, 50, {{"amplitude_um", 1}}) / mean == doctest::Approx(-0.054).epsilon(0.01).scale(0));
  for (const int m : {1, 2, 4, 5}) CHECK(harmonic(m, 50, {{"amplitude_um", 1}}) == doctest::Approx(0).epsilon(1e-9));
}

TEST_CASE("pretravel: stiff directions need twice the force of soft ones; 16 um range with 50 mm") {
  const auto at = [](double azimuth) {
    return reading_um(kPretravelLobing, touch(horizontal(azimuth)), {{"amplitude_um", 8}});
  };
  const double pole = reading_um(kPretravelLobing, touch({0, 0, 1}), {{"amplitude_um", 8}});
  CHECK((pole - at(kPi / 3)) / (pole - at(0)) == doctest::Approx(2));
  CHECK(at(0) - at(kPi / 3) == doctest::Approx(16));
  CHECK(at(0.3) == doctest::Approx(at(0.3 + 2 * kPi / 3)));
  CHECK(at(kPi / 3) < 0);  // more pretravel than the mean: the surface seems too far in
  CHECK(pole > 0);
}

TEST_CASE("pretravel: the mean over the hemisphere is contained in the qualified radius") {
  for (const double length : {20.0, 50.0, 100.0}) {
    const auto reading = [&](const Vec3& n) {
      return reading_um(kPretravelLobing, touch(n, length), {{"amplitude_um", 5}, {"phase_deg", 17}});
    };
    CHECK(std::fabs(mean_over_hemisphere(reading)) < 0.005 * harmonic(3, length, {{"amplitude_um", 5}}));
  }
}

TEST_CASE("pretravel: grows with the square of the length and turns with the probe body") {
  CHECK(harmonic(3, 100, {{"amplitude_um", 1}}) == doctest::Approx(4 * harmonic(3, 50, {{"amplitude_um", 1}})));
  CHECK(harmonic(3, 100, {{"amplitude_um", 1}, {"at_length_mm", 100}}) ==
        doctest::Approx(harmonic(3, 50, {{"amplitude_um", 1}})));
  const TouchScene here = touch(horizontal(0.4)), turned = touch(horizontal(0.4 + kPi / 3), 50, 0, kPi / 3);
  CHECK(reading_um(kPretravelLobing, here, {{"amplitude_um", 1}}) ==
        doctest::Approx(reading_um(kPretravelLobing, turned, {{"amplitude_um", 1}})));
  CHECK(reading_um(kPretravelLobing, here, {{"amplitude_um", 1}}) ==
        doctest::Approx(reading_um(kPretravelLobing, touch(horizontal(0.9)),
                                   {{"amplitude_um", 1}, {"phase_deg", 0.5 / kPi * 180}})));
  // At A = 90 the lobes lie in a vertical plane: the same readings for the same directions of the
  // body.
  const double b = 0.7;
  const Mat3 R = head_pose(kPi / 2, b);
  CHECK(reading_um(kPretravelLobing, touch(R * horizontal(0.4), 50, kPi / 2, b), {{"amplitude_um", 1}}) ==
        doctest::Approx(reading_um(kPretravelLobing, here, {{"amplitude_um", 1}})));
}

TEST_CASE("pretravel: weight matters when the body lies, and vanishes to first order from the mean") {
  const Parameters heavy = {{"amplitude_um", 1}, {"gravity_share", 0.1}}, light = {{"amplitude_um", 1}};
  const TouchScene upright = touch(horizontal(0.4));
  CHECK(reading_um(kPretravelLobing, upright, heavy) == doctest::Approx(reading_um(kPretravelLobing, upright, light)));
  // A = 90, B = 0: the body's x points up. The soft edge there restores 10 % more: 10 % of the
  // smallest pretravel, 2 um.
  const TouchScene lying = touch({0, 0, 1}, 50, kPi / 2);
  CHECK(lying.stylus.R_WR.cx.z == doctest::Approx(1));
  CHECK(reading_um(kPretravelLobing, lying, heavy) - reading_um(kPretravelLobing, lying, light) ==
        doctest::Approx(-0.2));
}

TEST_CASE("pretravel: a star stylus has finite readings all round") {
  TouchScene scene = touch({1, 0, 0}, 30);
  scene.stylus.to_head = {-1, 0, 0};
  for (int i = 0; i < 400; ++i) {
    scene.normal = unit({std::cos(0.1 * i), std::sin(0.1 * i), std::cos(0.037 * i)});
    CHECK(std::fabs(reading_um(kPretravelLobing, scene, {{"amplitude_um", 1}})) < 10);
  }
  // Touched from above, the star tips the seats about the edge behind it: soft at phase 0, stiff at
  // 60 degrees.
  scene.normal = {0, 0, 1};
  CHECK(reading_um(kPretravelLobing, scene, {{"amplitude_um", 1}, {"phase_deg", 60}}) <
        reading_um(kPretravelLobing, scene, {{"amplitude_um", 1}}) - 0.5);
  scene.stylus.length_mm = 0;
  CHECK(reading_um(kPretravelLobing, scene, {{"amplitude_um", 1}}) == 0);
}

TEST_CASE("stylus bending: published deflections at 0.1 N") {
  struct Case {
    double young_GPa, length_mm, diameter_mm, deflection_um;
  };
  for (const Case& c :
       {Case{620, 30, 1.5, 5.8}, Case{200, 50, 2, 26.5}, Case{620, 50, 2, 8.6}, Case{450, 100, 3, 18.6}}) {
    const auto with = [&](const Vec3& normal, Parameters named) {
      TouchScene scene = touch(normal, c.length_mm);
      scene.stylus.young_MPa = 1e3 * c.young_GPa;
      scene.stylus.shaft_diameter_mm = c.diameter_mm;
      return reading_um(kStylusBending, scene, named);
    };
    CHECK(with({1, 0, 0}, {{"force_change_N", 0.1}}) == doctest::Approx(-c.deflection_um).epsilon(0.01));
    CHECK(with({0, 0, 1}, {{"force_change_N", 0.1}}) == doctest::Approx(0));
    CHECK(with({0, 0, 1}, {{"force_N", 0.1}}) - with({1, 0, 0}, {{"force_N", 0.1}}) ==
          doctest::Approx(c.deflection_um).epsilon(0.01));
    CHECK(mean_over_hemisphere([&](const Vec3& n) {
            return with(n, {{"force_N", 0.1}});
          }) == doctest::Approx(0).epsilon(1e-3));
  }
}

TEST_CASE("stylus bending: follows the stylus, and a shaft of unknown size is rigid") {
  const TouchScene lying = touch({0, 0, 1}, 50, kPi / 2);
  CHECK(reading_um(kStylusBending, lying, {{"force_change_N", 0.1}}) == doctest::Approx(-8.56).epsilon(1e-3));
  TouchScene unknown = touch({1, 0, 0});
  unknown.stylus.shaft_diameter_mm = 0;
  CHECK(reading_um(kStylusBending, unknown, {{"force_N", 0.1}}) == 0);
}

TEST_CASE("tip radius: a larger tip reads out in every direction, for the stylus named") {
  for (const Vec3& n : {Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}})
    CHECK(reading_um(kTipRadius, touch(n), {{"amplitude_um", 0.7}}) == doctest::Approx(0.7));
  TouchScene second = touch({1, 0, 0});
  second.stylus.ordinal = 2;
  CHECK(reading_um(kTipRadius, second, {{"amplitude_um", 1}, {"sensor", 2}}) == doctest::Approx(1));
  CHECK(reading_um(kTipRadius, second, {{"amplitude_um", 1}, {"sensor", 1}}) == 0);
}

TEST_CASE("tip form: each draw is an orthogonal form without radius and centre, of unit rms together") {
  const auto form = [](int k, const Vec3& n) {
    std::vector<double> z(static_cast<std::size_t>(kTipForm.draws));
    z[static_cast<std::size_t>(k)] = 1;
    return reading_um(kTipForm, touch(n), {{"amplitude_um", 1}}, z);
  };
  // The whole sphere: a hemisphere and its mirror image.
  const auto mean = [](auto f) {
    const auto mirrored = [&](const Vec3& n) { return f(-n); };
    return 0.5 * (mean_over_hemisphere(f, 60, 16) + mean_over_hemisphere(mirrored, 60, 16));
  };
  CHECK(kTipForm.draws == 45);
  double power = 0;
  for (int k = 0; k < kTipForm.draws; ++k) {
    power += mean([&](const Vec3& n) { return form(k, n) * form(k, n); });
    CHECK(std::fabs(mean([&](const Vec3& n) { return form(k, n); })) < 1e-3);
    CHECK(std::fabs(mean([&](const Vec3& n) { return form(k, n) * n.x; })) < 1e-3);
    CHECK(std::fabs(mean([&](const Vec3& n) { return form(k, n) * n.z; })) < 1e-3);
    if (k > 0) CHECK(std::fabs(mean([&](const Vec3& n) { return form(k, n) * form(k - 1, n); })) < 1e-3);
  }
  CHECK(power == doctest::Approx(1).epsilon(1e-3));
}

TEST_CASE("tip form: the place of the ball that touches turns with the stylus") {
  std::vector<double> z(static_cast<std::size_t>(kTipForm.draws));
  for (std::size_t i = 0; i < z.size(); ++i) z[i] = std::sin(1.0 + 3.0 * static_cast<double>(i));
  const Vec3 n = unit({1, 2, 3});
  const Mat3 R = head_pose(1.1, -0.6);
  CHECK(reading_um(kTipForm, touch(R * n, 50, 1.1, -0.6), {{"amplitude_um", 1}}, z) ==
        doctest::Approx(reading_um(kTipForm, touch(n), {{"amplitude_um", 1}}, z)));
  std::vector<double> oval(static_cast<std::size_t>(kTipForm.draws));
  oval[2] = 1;  // degree 2, order 0: proud at the poles
  CHECK(reading_um(kTipForm, touch({0, 0, 1}), {{"amplitude_um", 1}}, oval) > 0);
  CHECK(reading_um(kTipForm, touch({1, 0, 0}), {{"amplitude_um", 1}}, oval) ==
        doctest::Approx(-0.5 * reading_um(kTipForm, touch({0, 0, -1}), {{"amplitude_um", 1}}, oval)));
}

TEST_CASE("contact flattening: Hertz for ruby on steel and aluminium") {
  const auto flattening = [](double radius_mm, double force_N, double young_GPa, double poisson) {
    TouchScene scene = touch({1, 0, 0});
    scene.stylus.radius_mm = radius_mm;
    return -reading_um(
        kContactFlattening, scene,
        {{"force_N", force_N}, {"part_young_GPa", young_GPa}, {"part_poisson", poisson}, {"sphere_radius_mm", 0}});
  };
  CHECK(flattening(1, 0.1, 210, 0.3) == doctest::Approx(0.063).epsilon(0.01).scale(0));
  CHECK(flattening(1, 0.1, 70, 0.33) == doctest::Approx(0.108).epsilon(0.01).scale(0));
  CHECK(flattening(1, 1, 210, 0.3) == doctest::Approx(0.29).epsilon(0.02).scale(0));
  CHECK(flattening(1, 1, 70, 0.33) == doctest::Approx(0.50).epsilon(0.02).scale(0));
  CHECK(flattening(0.25, 0.1, 210, 0.3) == doctest::Approx(0.10).epsilon(0.02).scale(0));
  CHECK(flattening(1, 8, 210, 0.3) == doctest::Approx(4 * flattening(1, 1, 210, 0.3)));
}

TEST_CASE("contact flattening: only the difference to the reference sphere remains") {
  const double soft = reading_um(kContactFlattening, touch({0, 0, 1}), {});
  CHECK(soft < 0);
  CHECK(soft > -0.1);
  const double same = reading_um(kContactFlattening, touch({0, 0, 1}),
                                 {{"part_young_GPa", 380}, {"part_poisson", 0.23}, {"sphere_radius_mm", 100}});
  CHECK(std::fabs(same) < 0.001);
  // A sphere as small as the tip is twice as curved as the plane part of its material: 2^(1/3) times the approach.
  const auto of_part = [](double sphere_radius_mm) {
    return reading_um(kContactFlattening, touch({0, 0, 1}),
                      {{"part_young_GPa", 380}, {"part_poisson", 0.23}, {"sphere_radius_mm", sphere_radius_mm}});
  };
  CHECK(of_part(1) == doctest::Approx((1 - std::cbrt(2)) * of_part(0)).scale(0));
}

TEST_CASE(
    "trigger delay: 1 ms at 8 mm/s reads 8 um in, in proportion to speed and to the cosine of the "
    "approach") {
  TouchScene scene = touch({1, 0, 0});
  CHECK(reading_um(kTriggerDelay, scene, {{"delay_ms", 1}}) == doctest::Approx(-8));
  scene.speed_mm_s = 2;
  CHECK(reading_um(kTriggerDelay, scene, {{"delay_ms", 1}}) == doctest::Approx(-2));
  scene.travel = unit({-1, 1, 0});
  CHECK(reading_um(kTriggerDelay, scene, {{"delay_ms", 1}}) == doctest::Approx(-std::sqrt(2.0)));
  scene.travel = {};  // not recorded: along the normal
  CHECK(reading_um(kTriggerDelay, scene, {{"delay_ms", 1}}) == doctest::Approx(-2));
  // As it was at the qualification it shows at another speed only, too far out at a slower one.
  CHECK(reading_um(kTriggerDelay, scene, {{"delay_ms", 1}, {"qualified_at_mm_s", 2}}) == doctest::Approx(0).scale(1));
  CHECK(reading_um(kTriggerDelay, scene, {{"delay_ms", 1}, {"qualified_at_mm_s", 8}}) == doctest::Approx(6));
}

TEST_CASE("cosine error: 3.8 um at 5 degrees with R = 1 mm, never negative, quadratic") {
  const auto at = [](double degrees, double radius_mm) {
    TouchScene scene = touch({1, 0, 0});
    scene.stylus.radius_mm = radius_mm;
    scene.travel = -1.0 * horizontal(degrees * kPi / 180);
    return reading_um(kCosineError, scene, {});
  };
  CHECK(at(5, 1) == doctest::Approx(3.8).epsilon(0.005));
  CHECK(at(-5, 1) == doctest::Approx(at(5, 1)));
  CHECK(at(5, 2) == doctest::Approx(2 * at(5, 1)));
  CHECK(at(2, 1) == doctest::Approx(4 * at(1, 1)).epsilon(1e-3));
  CHECK(at(0, 1) == 0);
}

TEST_CASE("stylus length: a longer stylus reads out, along the stylus of each orientation") {
  CHECK(reading_um(kStylusLength, touch({0, 0, 1}), {{"length_error_um", 3}}) == doctest::Approx(3));
  CHECK(reading_um(kStylusLength, touch({1, 0, 0}), {{"length_error_um", 3}}) == 0);
  // Against the paper's tip vector t = (sinA cosB, sinA sinB, -cosA) l: reported minus true = -dL t
  // / l.
  const double a = 1.0, b = 0.4;
  const Vec3 d = displacement_mm(kStylusLength, touch({0, 0, 1}, 50, a, b), {{"length_error_um", 1000}});
  CHECK(norm(d + Vec3{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), -std::cos(a)}) < 1e-12);
}

TEST_CASE("probe step: one stylus jumps at its time, by a vector of the probe body") {
  TouchScene scene = touch({0, 0, 1}, 50, kPi / 2);  // the body's axis lies along -X, its x points up
  scene.time_s = 99;
  CHECK(reading_um(kProbeStep, scene, {{"amplitude_um", 4}, {"t0_s", 100}}) == 0);
  scene.time_s = 100;
  CHECK(reading_um(kProbeStep, scene, {{"amplitude_um", 4}, {"t0_s", 100}}) == doctest::Approx(4));
  const Vec3 axial =
      displacement_mm(kProbeStep, scene, {{"amplitude_um", 4}, {"t0_s", 100}, {"direction", 3}, {"elevation_deg", 90}});
  CHECK(norm(axial - 4e-3 * scene.stylus.to_head) < 1e-12);
  CHECK(norm(axial - displacement_mm(kProbeStep, scene, {{"amplitude_um", 4}, {"t0_s", 100}, {"direction", 2}})) <
        1e-12);
  scene.stylus.tip_ordinal = 2;
  for (const double tip : {0, 2})
    CHECK(reading_um(kProbeStep, scene, {{"amplitude_um", 4}, {"t0_s", 100}, {"tip", tip}}) == doctest::Approx(4));
  CHECK(reading_um(kProbeStep, scene, {{"amplitude_um", 4}, {"t0_s", 100}, {"tip", 1}}) == 0);
  scene.stylus.ordinal = 3;
  CHECK(reading_um(kProbeStep, scene, {{"amplitude_um", 4}, {"t0_s", 100}, {"sensor", 2}}) == 0);
}

}  // namespace abbe
