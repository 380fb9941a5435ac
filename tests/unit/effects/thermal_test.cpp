// The thermal effects against the magnitudes of the catalogue, their signs and their signatures.
#include "engine/effects/thermal/thermal.hpp"

#include "tests/unit/effects/bench.hpp"

namespace abbe {

using namespace effects_test;

namespace {

/// A touch at `on_part` of a part whose axes are those of the machine.
/// A touch with the carriages at `reading` and the tip at `lever` from the frame of a carriage.
TouchScene touch_at(const Vec3& reading, const Vec3& lever, const Vec3& normal = {0, 0, 1}) {
  TouchScene scene = touch(normal);
  scene.reading = reading;
  for (Vec3& l : scene.lever_mm) l = lever;
  return scene;
}

TouchScene touch_after(double time_s, const Vec3& normal = {0, 0, 1}) {
  TouchScene scene = touch(normal);
  scene.time_s = time_s;
  return scene;
}

}  // namespace

TEST_CASE("part expansion: 500 mm of steel grow 5.75 um per kelvin") {
  TouchScene end = touch_on_part({500, 0, 0}, {1, 0, 0});
  end.temperature.part = 21;
  const double um = reading_um(kPartExpansion, end, {{"cte_error_ppm_per_K", 11.5}});
  CHECK(um == doctest::Approx(5.75));
  CHECK(reading_um(kPartExpansion, end, {{"temperature_error_K", 1}}) == doctest::Approx(um));
}

TEST_CASE("part expansion: published sizes of a wrong coefficient and a wrong sensor, per metre") {
  TouchScene end = touch_on_part({1000, 0, 0}, {1, 0, 0});
  end.temperature.part = 25;
  CHECK(reading_um(kPartExpansion, end, {{"cte_error_ppm_per_K", 1.15}}) == doctest::Approx(5.75));
  CHECK(reading_um(kPartExpansion, end, {{"temperature_error_K", 0.3}}) == doctest::Approx(3.45));
}

TEST_CASE("part expansion: a wrong coefficient vanishes at 20 degrees, a wrong sensor does not") {
  const TouchScene at_20 = touch_on_part({1000, 0, 0}, {1, 0, 0});
  CHECK(reading_um(kPartExpansion, at_20, {{"cte_error_ppm_per_K", 5}}) == 0);
  CHECK(reading_um(kPartExpansion, at_20, {{"temperature_error_K", 0.3}}) > 0);
}

TEST_CASE("part expansion: a part may be warm in one placement only") {
  TouchScene end = touch_on_part({1000, 0, 0}, {1, 0, 0});
  end.setup = 2;
  const auto warm_in = [&](double setup) {
    return reading_um(kPartExpansion, end, {{"temperature_error_K", 0.3}, {"setup", setup}});
  };
  CHECK(warm_in(2) == doctest::Approx(3.45));
  CHECK(warm_in(1) == 0);
}

TEST_CASE("part expansion: isotropic from the part's origin, in the part's frame") {
  // The part is turned by 90 degrees about z: its x is the machine's y.
  TouchScene scene = touch({0, 1, 0});
  scene.normal_on_part = {1, 0, 0};
  scene.on_part = {300, -40, 20};
  scene.temperature.part = 22;
  const Vec3 d = displacement_mm(kPartExpansion, scene, {{"cte_error_ppm_per_K", 10}});
  CHECK(d.y == doctest::Approx(300 * 10e-6 * 2));
  CHECK(d.x == 0);
  // The far wall of a bore moves outwards too: its normal points back to the origin.
  TouchScene bore = touch_on_part({300, 0, 0}, {-1, 0, 0});
  bore.temperature.part = 22;
  CHECK(reading_um(kPartExpansion, bore, {{"cte_error_ppm_per_K", 10}}) == doctest::Approx(-6));
}

TEST_CASE("part expansion: held elsewhere, the part's origin shifts with it") {
  // Held 200 mm along x from its origin, 10 ppm/K and 3 K: what is held stands still, what is 100 mm beyond moves 3 um.
  TouchScene held = touch_on_part({200, 0, 0}, {1, 0, 0}), beyond = touch_on_part({300, 0, 0}, {1, 0, 0});
  held.temperature.part = beyond.temperature.part = 23;
  const Parameters growth{{"cte_error_ppm_per_K", 10}, {"held", 1}, {"shift_x_um_per_K", -2}};
  CHECK(reading_um(kPartExpansion, held, growth) == doctest::Approx(0));
  CHECK(reading_um(kPartExpansion, beyond, growth) == doctest::Approx(3));
  CHECK(reading_um(kPartExpansion, held, {{"shift_x_um_per_K", -2}}) == 0);
}

TEST_CASE("scale expansion: a warmer scale reads short on its own axis only") {
  TouchScene scene = touch_at({1000, 500, -400}, {});
  scene.temperature.scale[0] = 22;
  const Vec3 d = displacement_mm(kScaleExpansion, scene, {{"cte_error_ppm_per_K", 1}});
  CHECK(d.x == doctest::Approx(-2e-3));
  CHECK(d.y == 0);
  CHECK(d.z == 0);
  const Vec3 sensor = displacement_mm(kScaleExpansion, scene, {{"z_temperature_error_K", 0.5}});
  CHECK(sensor.z == doctest::Approx(400 * 10.5e-6 * 0.5));
  CHECK(sensor.x == 0);
}

TEST_CASE("scale and part of one material and temperature: lengths do not change") {
  TouchScene end = touch_on_part({500, 0, 0}, {1, 0, 0});
  end.reading = {500, 0, 0};
  end.temperature.part = end.temperature.scale[0] = 23;
  CHECK(reading_um(kPartExpansion, end, {{"cte_error_ppm_per_K", 11.5}}) +
            reading_um(kScaleExpansion, end, {{"cte_error_ppm_per_K", 11.5}}) ==
        doctest::Approx(0));
}

TEST_CASE("table bending: granite, 0.5 K over 0.2 m: 5.2 um, 13 urad, 10.4 um of Abbe error") {
  const Parameters half_kelvin = {{"gradient_K", 0.5}};
  const Vec3 low = displacement_mm(kTableBending, touch_at({800, 0, 0}, {}), half_kelvin);
  CHECK(low.z == doctest::Approx(5.2e-3));
  CHECK(low.x == 0);
  const Vec3 high = displacement_mm(kTableBending, touch_at({800, 0, 0}, {0, 0, 800}), half_kelvin);
  CHECK(high.x == doctest::Approx(-10.4e-3));
  CHECK(high.z == doctest::Approx(low.z));
  CHECK((low.x - high.x) / 800 == doctest::Approx(13e-6).scale(0));
}

TEST_CASE("table bending: another origin of x is a rigid turn") {
  // d(s) - d(s - s0) must be a rotation about y: (d_x, d_z) = w (z, -x) + constant.
  const double s0 = 700;
  const Parameters bent = {{"gradient_K", 1}};
  const auto difference = [&](double s, double l_x, double l_z) {
    return displacement_mm(kTableBending, touch_at({s, 0, 0}, {l_x, 0, l_z}), bent) -
        displacement_mm(kTableBending, touch_at({s - s0, 0, 0}, {l_x, 0, l_z}), bent);
  };
  const Vec3 origin = difference(0, 0, 0), along = difference(900, 50, 0) - origin, up = difference(0, 0, 300) - origin;
  const double w = up.x / 300;
  CHECK(w != 0);
  CHECK(along.z == doctest::Approx(-w * (900 + 50)));
  CHECK(along.x == doctest::Approx(0));
  CHECK(up.z == doctest::Approx(0));
}

TEST_CASE("table bending: a table that moves along y carries the surface along the arch of its guide") {
  // The table stands at -s and the point of the part at c from its frame: an arch of curvature k lifts it by
  // k s^2/2 + k s c, the parabola that the guide itself has.
  const double k = 6.5e-6 * 0.5 / 200, c = -300, height = 250;
  for (const double s : {-600.0, 0.0, 200.0, 700.0}) {
    TouchScene scene = touch_at({50, s, 0}, {40, c + s, height});
    scene.side[1] = -1, scene.on_table = 1, scene.on_bridge = 0;
    const Vec3 d = displacement_mm(kTableBending, scene, {{"gradient_K", 0.5}});
    CHECK(d.z == doctest::Approx(k * s * s / 2 + k * s * c).scale(1e-3));
    CHECK(d.y == doctest::Approx(-k * s * height).scale(1e-3));
    CHECK(d.x == 0);
  }
}

TEST_CASE("table bending: the logged gradient bends by its share") {
  TouchScene scene = touch_at({800, 0, 0}, {});
  scene.temperature.table_top_minus_bottom_K = 0.5;
  CHECK(reading_um(kTableBending, scene, {{"logged_share", 1}}) == doctest::Approx(5.2));
  CHECK(reading_um(kTableBending, scene, {}) == 0);
}

TEST_CASE("bridge bending: aluminium beam, 0.2 K, 1 m: 2.9 um bow") {
  const Parameters warm = {{"gradient_K", 0.2}};
  const double um = reading_um(kBridgeBending, touch_at({0, 500, 0}, {}), warm);
  CHECK(um == doctest::Approx(2.9).epsilon(0.01));
  // Below the beam the saddle's roll makes an error in y: the arch tips the ram outwards at its
  // foot.
  const Vec3 below = displacement_mm(kBridgeBending, touch_at({0, 500, 0}, {0, 0, -600}), warm);
  CHECK(below.y == doctest::Approx(23.1e-6 * 0.2 / 200 * 500 * 600));
  CHECK(below.x == 0);
}

TEST_CASE("bridge bending: legs 1 m high, 1.2 m apart, 0.2 K: a rigid roll of 3.8 urad") {
  const Parameters legs = {{"legs_K", 0.2}};
  const auto at = [&](double y, double z) {
    return displacement_mm(kBridgeBending, touch_at({0, y, 0}, {0, 0, z}), legs);
  };
  const double roll = (at(0, 0).y - at(0, -600).y) / 600;
  CHECK(roll == doctest::Approx(3.85e-6).scale(0));
  CHECK((at(0, 0).z - at(1000, 0).z) / 1000 == doctest::Approx(roll).scale(0));
  CHECK(at(1000, -600).y == doctest::Approx(at(0, -600).y));
  CHECK(at(0, -1000).y == doctest::Approx(0));  // the foot stays
}

TEST_CASE("time constants: aluminium wall 1.4 h, granite table 12 h") {
  CHECK(kAluminiumWall_s / 3600 == doctest::Approx(1.35));
  CHECK(kGraniteTable_s / 3600 == doctest::Approx(12));
}

TEST_CASE("drift: starts at zero, reaches 63 % after one time constant, settles at its amplitude") {
  const Parameters up = {{"amplitude_um", 3}, {"direction", 2}, {"tau_s", 1000}};
  CHECK(reading_um(kThermalDrift, touch_after(0), up) == 0);
  CHECK(reading_um(kThermalDrift, touch_after(1000), up) == doctest::Approx(3 * (1 - std::exp(-1))));
  CHECK(reading_um(kThermalDrift, touch_after(1e5), up) == doctest::Approx(3));
}

TEST_CASE("drift: with two exponentials the slow one carries its share") {
  const Parameters two = {
      {"amplitude_um", 4}, {"direction", 2}, {"tau_s", 100}, {"second_share", 0.25}, {"second_tau_s", 1e5}};
  const double fast_only = reading_um(kThermalDrift, touch_after(2000), two);
  CHECK(fast_only == doctest::Approx(3 + 1 - std::exp(-0.02)));
  CHECK(reading_um(kThermalDrift, touch_after(2e6), two) == doctest::Approx(4));
}

TEST_CASE("drift: along an axis, or oblique with the same length") {
  const Vec3 y = displacement_mm(kThermalDrift, touch_after(1e6), {{"amplitude_um", 2}, {"direction", 1}});
  CHECK(y.y == doctest::Approx(2e-3));
  CHECK(y.x == 0);
  const Vec3 oblique =
      displacement_mm(kThermalDrift, touch_after(1e6),
                      {{"amplitude_um", 2}, {"direction", 3}, {"azimuth_deg", 90}, {"elevation_deg", 30}});
  CHECK(norm(oblique) == doctest::Approx(2e-3));
  CHECK(oblique.z == doctest::Approx(1e-3));
  CHECK(oblique.x == doctest::Approx(0));
}

TEST_CASE("cycle: comes back after a period, turns over after half of it") {
  const auto at = [](double time_s) {
    return reading_um(kThermalCycle, touch_after(time_s),
                      {{"amplitude_um", 1.5}, {"period_s", 1200}, {"direction", 2}});
  };
  CHECK(at(300) == doctest::Approx(1.5));
  CHECK(at(900) == doctest::Approx(-1.5));
  CHECK(at(100 + 1200) == doctest::Approx(at(100)));
  CHECK(reading_um(kThermalCycle, touch_after(0), {{"amplitude_um", 1.5}, {"phase_deg", 30}, {"direction", 2}}) ==
        doctest::Approx(0.75));
}

TEST_CASE("ram growth: aluminium ram 800 mm out, 0.5 K: 9 um, and only in z") {
  const Parameters warm = {{"rise_K", 0.5}, {"tau_s", 0}, {"length_at_zero_mm", 0}};
  const Vec3 out = displacement_mm(kRamGrowth, touch_at({0, 0, -800}, {}), warm);
  CHECK(out.z == doctest::Approx(9.24e-3));
  CHECK(out.x == 0);
  CHECK(out.y == 0);
  CHECK(displacement_mm(kRamGrowth, touch_at({0, 0, 0}, {}), warm).z == 0);
}

TEST_CASE("stylus growth: 100 mm steel 1.2 um/K, carbide 0.5, reads + on a face towards the head") {
  TouchScene scene = touch({0, 0, 1}, 100);
  scene.stylus.cte_per_K = 11.5e-6;
  const Parameters warm = {{"rise_K", 1}, {"tau_s", 0}};
  CHECK(reading_um(kStylusGrowth, scene, warm) == doctest::Approx(1.15));
  scene.stylus.cte_per_K = 5e-6;
  CHECK(reading_um(kStylusGrowth, scene, warm) == doctest::Approx(0.5));
  scene.stylus.length_mm = 300;
  CHECK(reading_um(kStylusGrowth, scene, warm) == doctest::Approx(1.5));
  scene.normal = {1, 0, 0};
  CHECK(reading_um(kStylusGrowth, scene, warm) == doctest::Approx(0));
}

TEST_CASE("stylus growth: turns with the head") {
  TouchScene scene = touch({-1, 0, 0}, 100, kPi / 2, 0);  // A = 90, B = 0: the tip looks along +x
  scene.stylus.cte_per_K = 11.5e-6;
  CHECK(reading_um(kStylusGrowth, scene, {{"rise_K", 1}, {"tau_s", 0}}) == doctest::Approx(1.15));
}

TEST_CASE("part soak: 1 K left over 500 mm of steel is 5.75 um at the start, and dies away") {
  TouchScene end = touch_on_part({500, 0, 0}, {1, 0, 0});
  const Parameters warm = {{"start_K", 1}, {"tau_s", 3600}};
  CHECK(reading_um(kPartSoak, end, warm) == doctest::Approx(5.75));
  end.time_s = 3600;
  CHECK(reading_um(kPartSoak, end, warm) == doctest::Approx(5.75 * std::exp(-1)));
  end.time_s = 1e6;
  CHECK(reading_um(kPartSoak, end, warm) == doctest::Approx(0));
  TouchScene held = touch_on_part({200, 0, 0}, {1, 0, 0});  // where it is held: 2.3 um of growth, and as much of shift
  const Parameters both = {{"start_K", 1}, {"tau_s", 3600}, {"held", 1}, {"shift_x_um", -2.3}};
  CHECK(reading_um(kPartSoak, held, both) == doctest::Approx(0));
  held.time_s = 3600;  // and as much of both is left later
  CHECK(reading_um(kPartSoak, held, both) == doctest::Approx(0));
}

}  // namespace abbe
