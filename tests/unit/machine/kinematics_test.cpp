// The kinematics of the machine and the head against an independent implementation
// (tests/reference/kinematics.json).
#include <doctest/doctest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/machine/geometry.hpp"
#include "engine/machine/head.hpp"

namespace abbe {

namespace {

using Json = nlohmann::json;

Vec3 vec3(const Json& j) { return {j[0], j[1], j[2]}; }

void check_near(const Vec3& got, const Vec3& expected, double tolerance) {
  for (int k = 0; k < 3; ++k) {
    CAPTURE(k);
    CHECK(std::fabs(got[k] - expected[k]) <= tolerance);
  }
}

struct Case {
  Machine machine;
  AxisErrors errors;
  Vec3 enc, tip_in_r, t, head_error;
  double a = 0, b = 0;
};

Case read(const Json& j) {
  Case c;
  for (int k = 0; k < 3; ++k) {
    const char* axis[] = {"x", "y", "z"};
    c.machine.axes[k].offset_mm = vec3(j["offsets_mm"][axis[k]]);
    const Json& e = j["errors"][axis[k]];
    for (int m = 0; m < 3; ++m) {
      c.errors.value[6 * k + m] = double(e["translation_um"][m]) * 1e-3;
      c.errors.value[6 * k + 3 + m] = double(e["rotation_um_per_m"][m]) * 1e-6;
    }
  }
  c.machine.mount_offset_mm = vec3(j["offsets_mm"]["m"]);
  c.enc = vec3(j["scale_reading_mm"]);
  c.a = double(j["head_deg"][0]) * kPi / 180;
  c.b = double(j["head_deg"][1]) * kPi / 180;
  c.tip_in_r = vec3(j["tip_in_r_mm"]);
  c.t = head_rotation(c.a, c.b) * c.tip_in_r + Vec3{0, 0, -double(j["l_r_mm"])};
  const double arcsec = kPi / 180 / 3600;
  c.head_error = double(j["head_error_arcsec"][0]) * arcsec * head_derivative_a(c.a, c.b, c.tip_in_r) +
      double(j["head_error_arcsec"][1]) * arcsec * head_derivative_b(c.a, c.b, c.tip_in_r);
  return c;
}

}  // namespace

TEST_CASE("kinematics of machine and head agree with the reference to 1e-6 um") {
  std::ifstream file(ABBE_SOURCE_DIR "/tests/reference/kinematics.json");
  const Json reference = Json::parse(file);
  REQUIRE(reference["cases"].size() >= 5);
  constexpr double kTolerance_mm = 1e-9;
  for (const Json& j : reference["cases"]) {
    const Case c = read(j);
    const Json& expected = j["expected"];
    check_near(c.t, vec3(expected["tip_from_mount_mm"]), kTolerance_mm);
    check_near(c.enc + c.machine.home_offset() + c.t, vec3(expected["nominal_tip_mm"]), kTolerance_mm);
    check_near(geometric_error(c.machine, c.errors, c.enc, c.t),
               1e-3 * vec3(expected["geometric_error_first_order_um"]), kTolerance_mm);
    check_near(geometric_error_exact(c.machine, c.errors, c.enc, c.t),
               1e-3 * vec3(expected["geometric_error_exact_product_um"]), kTolerance_mm);
    check_near(c.head_error, 1e-3 * vec3(expected["head_error_um"]), kTolerance_mm);
  }
}

TEST_CASE("the head's derivatives are those of its rotation") {
  const Vec3 tip{20, 5, -100};
  const double a = 0.7, b = -1.9, h = 1e-5;
  check_near(head_derivative_a(a, b, tip), (head_rotation(a + h, b) * tip - head_rotation(a - h, b) * tip) / (2 * h),
             1e-7);
  check_near(head_derivative_b(a, b, tip), (head_rotation(a, b + h) * tip - head_rotation(a, b - h) * tip) / (2 * h),
             1e-7);
  check_near(head_rotation(0, 0) * Vec3{0, 0, -1}, {0, 0, -1}, 0);
}

}  // namespace abbe
