// The effects of the head against the head's geometry (paper, eq. 25) and beam theory.
#include "engine/effects/head/head.hpp"

#include "tests/unit/effects/bench.hpp"

namespace abbe {

using namespace effects_test;

namespace {

/// The paper's tip vector of a straight stylus, eq. 25 with l_r = 0.
Vec3 tip(double a, double b, double length_mm) {
  return length_mm * Vec3{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), -std::cos(a)};
}

std::vector<double> one_of(const Effect& effect, int k) {
  std::vector<double> z(static_cast<std::size_t>(effect.draws));
  z[static_cast<std::size_t>(k)] = 1;
  return z;
}

}  // namespace

TEST_CASE("re-indexing: derivatives of the tip by the two angles, for any mounting of the head") {
  for (const double a : {0.0, 0.5, kPi / 2, -1.2})
    for (const double b : {0.0, 1.0, -2.5}) {
      const double h = 1e-6;
      const Vec3 by_a = (tip(a + h, b, 100) - tip(a - h, b, 100)) / (2 * h),
                 by_b = (tip(a, b + h, 100) - tip(a, b - h, 100)) / (2 * h);
      const TouchScene scene = touch({1, 0, 0}, 100, a, b);
      CHECK(norm(displacement_mm(kHeadReindexing, scene, {{"sd_urad", 1e6}}, {1, 0}) - by_a) < 1e-6);
      CHECK(norm(displacement_mm(kHeadReindexing, scene, {{"sd_urad", 1e6}}, {0, 1}) - by_b) < 1e-6);
    }
  TouchScene mounted = touch({1, 0, 0}, 100, 0.5, 0.2);
  const Mat3 M = rotation({0, 0, 1}, 0.3);
  const Vec3 unmounted = displacement_mm(kHeadReindexing, mounted, {{"sd_urad", 1}}, {1, 2});
  mounted.stylus.R_WR = M * mounted.stylus.R_WR;
  mounted.stylus.to_head = M * mounted.stylus.to_head;
  CHECK(norm(displacement_mm(kHeadReindexing, mounted, {{"sd_urad", 1}}, {1, 2}) - M * unmounted) < 1e-15);
}

TEST_CASE("what is fixed to the ram is not turned") {
  TouchScene fixed = touch({1, 0, 0}, 100, 0.5, 0.2);
  fixed.stylus.indexed = false;
  CHECK(norm(displacement_mm(kHeadReindexing, fixed, {{"sd_urad", 10}}, {1, 2})) == 0);
  CHECK(norm(displacement_mm(kHeadAxisErrors, fixed, {{"translation_um", 1}, {"rotation_urad", 10}},
                             one_of(kHeadAxisErrors, 0))) == 0);
}

TEST_CASE("re-indexing: 0.5 um at 62 mm is two standard deviations; drawn per visit") {
  CHECK(2 * reading_um(kHeadReindexing, touch({1, 0, 0}, 62), {{"sd_urad", 4.03}}, {1, 0}) ==
        doctest::Approx(0.5).epsilon(0.001));
  CHECK(reading_um(kHeadReindexing, touch({1, 0, 0}, 150), {{"sd_urad", 4}}, {1, 0}) == doctest::Approx(0.6));
  CHECK(kHeadReindexing.draws_per == DrawsPer::visit);
}

TEST_CASE("axis errors: nothing at A = B = 0; a constant vector for each orientation") {
  std::vector<double> z(static_cast<std::size_t>(kHeadAxisErrors.draws));
  for (std::size_t i = 0; i < z.size(); ++i) z[i] = std::cos(1.0 + 2.0 * static_cast<double>(i));
  const Parameters both = {{"translation_um", 3}, {"rotation_urad", 20}};
  CHECK(norm(displacement_mm(kHeadAxisErrors, touch({1, 0, 0}), both, z)) == 0);
  const Vec3 d = displacement_mm(kHeadAxisErrors, touch({1, 0, 0}, 100, 1, 2), both, z);
  CHECK(norm(d - displacement_mm(kHeadAxisErrors, touch({0, 1, 0}, 100, 1, 2), both, z)) == 0);
  CHECK(norm(d) > 1e-3);
  CHECK(norm(d) < 0.1);
}

TEST_CASE("axis errors: translations are the same for all lengths, rotations grow with it") {
  std::vector<double> z(static_cast<std::size_t>(kHeadAxisErrors.draws), 1.0);
  const auto at = [&](double length, Parameters named) {
    return displacement_mm(kHeadAxisErrors, touch({1, 0, 0}, length, 1, 2), named, z);
  };
  CHECK(norm(at(100, {{"translation_um", 1}}) - at(50, {{"translation_um", 1}})) < 1e-15);
  CHECK(norm(at(100, {{"rotation_urad", 1}}) - 2 * at(50, {{"rotation_urad", 1}})) < 1e-15);
}

TEST_CASE("axis errors: those of A turn with B, those of B do not") {
  // Draw 1 is the sine of A's translation along x; 24 later the same of B.
  const Vec3 of_a = displacement_mm(kHeadAxisErrors, touch({1, 0, 0}, 50, kPi / 2, kPi / 2), {{"translation_um", 1}},
                                    one_of(kHeadAxisErrors, 1));
  const Vec3 of_b = displacement_mm(kHeadAxisErrors, touch({1, 0, 0}, 50, kPi / 2, kPi / 2), {{"translation_um", 1}},
                                    one_of(kHeadAxisErrors, 25));
  CHECK(norm(of_a - Vec3{0, 1e-3, 0}) < 1e-15);
  CHECK(norm(of_b - Vec3{1e-3, 0, 0}) < 1e-15);
  // The sine of A's rotation about its own y: at A = 90 and B = 0 the tip, at +X 100 mm, moves by
  // -z.
  const Vec3 turned = displacement_mm(kHeadAxisErrors, touch({0, 0, 1}, 100, kPi / 2, 0), {{"rotation_urad", 10}},
                                      one_of(kHeadAxisErrors, 4 * 4 + 1));
  CHECK(norm(turned - Vec3{0, 0, -1e-3}) < 1e-15);
}

TEST_CASE(
    "sag: the machine reads too high when the stylus lies, on either side, and right when it "
    "hangs") {
  const Parameters bar = {{"bending_um", 2}, {"joint_um", 1}};
  CHECK(reading_um(kHeadSag, touch({0, 0, 1}, 200), bar) == 0);
  CHECK(reading_um(kHeadSag, touch({0, 0, 1}, 200, kPi / 2), bar) == doctest::Approx(3));
  CHECK(reading_um(kHeadSag, touch({0, 0, 1}, 200, -kPi / 2, 1), bar) == doctest::Approx(3));
  CHECK(reading_um(kHeadSag, touch({0, 0, 1}, 400, kPi / 2), bar) == doctest::Approx(8 * 2 + 4 * 1));
  // Across the stylus by sin A in size: no lengthening of the bar.
  const TouchScene half = touch({0, 0, 1}, 200, kPi / 6);
  const Vec3 d = displacement_mm(kHeadSag, half, bar);
  CHECK(norm(d) == doctest::Approx(3e-3 * 0.5));
  CHECK(dot(d, half.stylus.to_head) == doctest::Approx(0));
}

TEST_CASE(
    "qualification: nothing at its temperature; then each orientation drifts along its own "
    "vector") {
  TouchScene scene = touch({0, 0, 1}, 100);
  CHECK(reading_um(kHeadQualification, scene,
                   {{"growth_um_per_K", 1.15}, {"tilt_a_urad_per_K", 5}, {"tilt_b_urad_per_K", 5}}) == 0);
  scene.temperature.air = 22;
  CHECK(reading_um(kHeadQualification, scene, {{"growth_um_per_K", 1.15}}) == doctest::Approx(2.3));
  CHECK(reading_um(kHeadQualification, scene, {{"growth_um_per_K", 1.15}, {"qualified_at_C", 22}}) == 0);
  TouchScene lying = touch({0, 0, 1}, 100, kPi / 2);
  lying.temperature.air = 22;
  const Vec3 growth = displacement_mm(kHeadQualification, lying, {{"growth_um_per_K", 1.15}});
  CHECK(norm(growth - 2.3e-3 * lying.stylus.to_head) < 1e-15);
  const Vec3 tilt = displacement_mm(kHeadQualification, lying, {{"tilt_a_urad_per_K", 5}, {"tilt_b_urad_per_K", 3}});
  CHECK(norm(tilt - 1e-3 * Vec3{0, 2 * 0.3, 2 * 0.5}) < 1e-12);
}

}  // namespace abbe
