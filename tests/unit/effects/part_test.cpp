// The effects of the part and its fixture: magnitudes, signs and signatures.
#include "engine/effects/part/part.hpp"

#include <Eigen/QR>
#include <algorithm>

#include "tests/unit/effects/bench.hpp"

namespace abbe {

using namespace effects_test;

namespace {

TouchScene touch_under_load(double load_kg, const Vec3& reading, const Vec3& lever) {
  TouchScene scene = touch({0, 0, 1});
  scene.load_kg = load_kg;
  scene.reading = reading;
  for (Vec3& l : scene.lever_mm) l = lever;
  scene.travel_length_mm = {1600, 1000, 800};
  return scene;
}

}  // namespace

TEST_CASE("load bending: the sag of the middle against the ends, in proportion to the mass") {
  // Against the straight line through both ends of the travel, which an alignment takes out.
  const auto sag_um = [](double load_kg) {
    const auto z = [&](double x) {
      return reading_um(kLoadBending, touch_under_load(load_kg, {x, 0, 0}, {}), {{"sag_um_per_500kg", 1.5}});
    };
    return z(800) - (z(0) + z(1600)) / 2;
  };
  // The guide is low in the middle; the machine does not know, so straight parts read high there.
  CHECK(sag_um(500) == doctest::Approx(1.5));
  CHECK(sag_um(1000) == doctest::Approx(3));
  CHECK(sag_um(0) == 0);
}

TEST_CASE("load bending: opposite to an arch, with its Abbe part, and round unless told otherwise") {
  const Parameters bowl = {{"sag_um_per_500kg", 1}};
  const Vec3 low = displacement_mm(kLoadBending, touch_under_load(500, {400, 0, 0}, {}), bowl);
  const Vec3 across = displacement_mm(kLoadBending, touch_under_load(500, {0, 400, 0}, {}), bowl);
  CHECK(low.z < 0);
  CHECK(across.z == doctest::Approx(low.z).scale(0));
  const Vec3 high = displacement_mm(kLoadBending, touch_under_load(500, {400, 0, 0}, {0, 0, 500}), bowl);
  CHECK(high.x == doctest::Approx(8e-3 / (1600. * 1600.) * 400 * 500));
  const Parameters rails = {{"sag_um_per_500kg", 1}, {"cross_share", 0}};
  CHECK(displacement_mm(kLoadBending, touch_under_load(500, {0, 400, 0}, {}), rails) == Vec3{});
}

TEST_CASE("load bending: a mass given as a parameter counts like a logged one") {
  const TouchScene logged = touch_under_load(300, {400, 300, 0}, {0, 0, 200});
  const TouchScene unknown = touch_under_load(0, {400, 300, 0}, {0, 0, 200});
  CHECK(displacement_mm(kLoadBending, logged, {{"sag_um_per_500kg", 2}}) ==
        displacement_mm(kLoadBending, unknown, {{"sag_um_per_500kg", 2}, {"mass_kg", 300}}));
}

TEST_CASE("load bending: the load may be on the table in one placement only") {
  TouchScene scene = touch_under_load(300, {400, 300, 0}, {0, 0, 200});
  scene.setup = 2;
  const Parameters everywhere = {{"sag_um_per_500kg", 2}};
  const auto in_setup = [&](double setup) {
    return displacement_mm(kLoadBending, scene, {{"sag_um_per_500kg", 2}, {"setup", setup}});
  };
  CHECK(in_setup(2) == displacement_mm(kLoadBending, scene, everywhere));
  CHECK(in_setup(1) == Vec3{});
}

TEST_CASE("clamping: deflections at half the part's size") {
  const Vec3 up{0, 0, 1};
  CHECK(reading_um(kClamping, touch_on_part({250, 0, 0}, up), {{"bow_um", 3}}) == doctest::Approx(3));
  CHECK(reading_um(kClamping, touch_on_part({0, -250, 0}, up), {{"cross_bow_um", 3}}) == doctest::Approx(3));
  CHECK(reading_um(kClamping, touch_on_part({250, -250, 0}, up), {{"twist_um", 3}}) == doctest::Approx(-3));
  // Three lobes: alike at 120 degrees, opposite in between.
  const auto lobe = [&](double degrees) {
    const double a = degrees * kDegree;
    return reading_um(kClamping, touch_on_part({250 * std::cos(a), 250 * std::sin(a), 0}, up), {{"three_point_um", 2}});
  };
  CHECK(lobe(0) == doctest::Approx(2));
  CHECK(lobe(120) == doctest::Approx(2));
  CHECK(lobe(60) == doctest::Approx(-2));
}

TEST_CASE("clamping: another placement of the part is another clamping") {
  TouchScene scene = touch({0, 0, 1});
  scene.normal_on_part = {0, 0, 1};
  scene.on_part = {250, 0, 0};
  scene.setup = 2;
  for (const double setup : {0, 2})
    CHECK(reading_um(kClamping, scene, {{"bow_um", 3}, {"setup", setup}}) == doctest::Approx(3));
  CHECK(reading_um(kClamping, scene, {{"bow_um", 3}, {"setup", 1}}) == 0);
}

TEST_CASE("clamping: sections stay plane and normal to the bent middle plane") {
  // The side displacement at height z is -z times the slope, found here by differences of w.
  const Parameters modes = {{"bow_um", 3}, {"cross_bow_um", -2}, {"twist_um", 5}, {"three_point_um", 1.5}};
  const auto w = [&](double x, double y) { return reading_um(kClamping, touch_on_part({x, y, 0}, {0, 0, 1}), modes); };
  const double x = 120, y = -70, z = 40, h = 1e-2;
  CHECK(reading_um(kClamping, touch_on_part({x, y, z}, {1, 0, 0}), modes) ==
        doctest::Approx(-z * (w(x + h, y) - w(x - h, y)) / (2 * h)).epsilon(1e-6));
  CHECK(reading_um(kClamping, touch_on_part({x, y, z}, {0, 1, 0}), modes) ==
        doctest::Approx(-z * (w(x, y + h) - w(x, y - h)) / (2 * h)).epsilon(1e-6));
}

TEST_CASE("clamping: what does not stretch may lie beside the part's origin") {
  const auto sideways = [](double z, double neutral) {
    return reading_um(kClamping, touch_on_part({125, 0, z}, {1, 0, 0}), {{"bow_um", 3}, {"neutral_mm", neutral}});
  };
  CHECK(sideways(40, 40) == 0);
  // 10 mm below it: the slope there, 2 x 3 um x 125 / 250^2 per mm, times as many.
  CHECK(sideways(30, 40) == doctest::Approx(10 * 2 * 3. * 125 / (250 * 250)));
}

TEST_CASE("form: lobes repeat at their angle and sit where the help says") {
  const auto at = [](std::string_view name, double degrees) {
    const double a = degrees * kDegree;
    return reading_um(kPartForm, touch_on_part({}, {std::cos(a), std::sin(a), 0}), {{name, 1}});
  };
  CHECK(at("oval_um", 0) == doctest::Approx(1));
  CHECK(at("oval_um", 90) == doctest::Approx(-1));
  CHECK(at("oval_45_um", 45) == doctest::Approx(1));
  CHECK(at("three_lobe_um", 0) == doctest::Approx(1));
  CHECK(at("three_lobe_um", 240) == doctest::Approx(1));
  CHECK(at("three_lobe_30_um", 30) == doctest::Approx(1));
  CHECK(at("egg_um", 77) == doctest::Approx(-0.5));
  CHECK(reading_um(kPartForm, touch_on_part({}, {0, 0, -1}), {{"egg_um", 1}}) == doctest::Approx(1));
  const double s = std::sqrt(0.5);
  CHECK(reading_um(kPartForm, touch_on_part({}, {s, 0, s}), {{"oval_xz_um", 1}}) == doctest::Approx(1));
  CHECK(reading_um(kPartForm, touch_on_part({}, {0, s, s}), {{"oval_yz_um", 1}}) == doctest::Approx(1));
  CHECK(reading_um(kPartForm, touch_on_part({}, {0, 0, -1}), {{"pear_um", 1}}) == doctest::Approx(-1));
  CHECK(at("three_lobe_xz_um", 0) > 0.7);
  CHECK(at("three_lobe_yz_um", 90) > 0.7);
  CHECK(at("crossed_oval_um", 0) == doctest::Approx(0));
}

constexpr std::string_view kHarmonicsOfForm[] = {
    "oval_um",          "oval_45_um",       "oval_xz_um",       "oval_yz_um", "egg_um",          "three_lobe_um",
    "three_lobe_30_um", "three_lobe_xz_um", "three_lobe_yz_um", "pear_um",    "crossed_oval_um", "crossed_oval_45_um"};

TEST_CASE("form: harmonics have a largest value of 1") {
  for (const std::string_view name : kHarmonicsOfForm) {
    CAPTURE(name);
    double largest = 0;
    for (int i = 0; i <= 180; ++i)
      for (int j = 0; j < 360; j += 2) {
        const double from_pole = i * kDegree, a = j * kDegree;
        const Vec3 n{std::sin(from_pole) * std::cos(a), std::sin(from_pole) * std::sin(a), std::cos(from_pole)};
        largest = std::max(largest, reading_um(kPartForm, touch_on_part({}, n), {{name, 1}}));
      }
    CHECK(largest == doctest::Approx(1).epsilon(1e-3));
  }
}

TEST_CASE("form: turning the part makes no other form of it") {
  // Degrees 2 and 3 as a whole are closed under rotation: five and seven harmonics fit any turned one exactly.
  const auto turned = [](const Vec3& n) {
    return Vec3{0.36 * n.x + 0.48 * n.y - 0.8 * n.z, -0.8 * n.x + 0.6 * n.y, 0.48 * n.x + 0.64 * n.y + 0.6 * n.z};
  };
  constexpr int kPoints = 200;
  const auto count = static_cast<Eigen::Index>(std::size(kHarmonicsOfForm));
  Eigen::MatrixXd upright(kPoints, count), lying(kPoints, count);
  for (int i = 0; i < kPoints; ++i) {
    const double z = -1 + 2 * (i + 0.5) / kPoints, a = 2.4 * i, across = std::sqrt(1 - z * z);
    const Vec3 n{across * std::cos(a), across * std::sin(a), z};
    for (Eigen::Index k = 0; k < count; ++k) {
      upright(i, k) = reading_um(kPartForm, touch_on_part({}, n), {{kHarmonicsOfForm[k], 1}});
      lying(i, k) = reading_um(kPartForm, touch_on_part({}, turned(n)), {{kHarmonicsOfForm[k], 1}});
    }
  }
  const Eigen::MatrixXd fitted = upright * upright.colPivHouseholderQr().solve(lying);
  CHECK((fitted - lying).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("form: the harmonics are orthogonal to radius and centre of a sphere") {
  constexpr int kRings = 60, kSectors = 60;
  for (const std::string_view name : kHarmonicsOfForm) {
    CAPTURE(name);
    double mean = 0;
    Vec3 centre;
    for (int i = 0; i < kRings; ++i)
      for (int j = 0; j < kSectors; ++j) {
        const double z = -1 + 2 * (i + 0.5) / kRings, a = 2 * kPi * j / kSectors;
        const double across = std::sqrt(1 - z * z);
        const Vec3 n{across * std::cos(a), across * std::sin(a), z};
        const double r = reading_um(kPartForm, touch_on_part({}, n), {{name, 1}});
        mean += r / (kRings * kSectors);
        centre += r / (kRings * kSectors) * n;
      }
    CHECK(std::fabs(mean) < 1e-3);
    CHECK(norm(centre) < 1e-3);
  }
}

TEST_CASE("form: faces have a wave over the position along its axis") {
  const auto at = [](double y, std::string_view name) {
    TouchScene face = touch_on_part({7, y, 3}, {0, 0, 1});
    face.curved = false;
    return reading_um(kPartForm, face, {{name, 2}, {"wavelength_mm", 40}, {"axis", 1}});
  };
  CHECK(at(10, "wave_um") == doctest::Approx(2));
  CHECK(at(0, "wave_cosine_um") == doctest::Approx(2));
  CHECK(at(3 + 40, "wave_um") == doctest::Approx(at(3, "wave_um")));
}

TEST_CASE("form: goes with the part, not with the machine") {
  TouchScene scene = touch_on_part({10, 20, 30}, {1, 0, 0});
  const double before = reading_um(kPartForm, scene, {{"oval_um", 1}, {"wave_um", 1}});
  scene.normal = {0, -1, 0};
  scene.point = {500, 400, -300};
  CHECK(reading_um(kPartForm, scene, {{"oval_um", 1}, {"wave_um", 1}}) == doctest::Approx(before));
}

TEST_CASE("shift: nothing before, one vector after, for every normal") {
  TouchScene scene = touch({0, 0, 1});
  const Parameters slip = {{"amplitude_um", 5}, {"t0_s", 100}, {"direction", 1}};
  scene.time_s = 99;
  CHECK(displacement_mm(kPartShift, scene, slip) == Vec3{});
  scene.time_s = 100;
  CHECK(displacement_mm(kPartShift, scene, slip) == Vec3{0, 5e-3, 0});
  CHECK(reading_um(kPartShift, scene, slip) == 0);
  scene.normal = {0, 1, 0};
  CHECK(reading_um(kPartShift, scene, slip) == doctest::Approx(5));
}

}  // namespace abbe
