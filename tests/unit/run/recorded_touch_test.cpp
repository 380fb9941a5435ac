#include "engine/run/recorded_touch.hpp"

#include <doctest/doctest.h>

#include "engine/effects/effect.hpp"
#include "engine/machine/machine.hpp"

using namespace abbe;

namespace {

/// Eight touches of a ball whose surface seems `off_mm` too far out at each, with raw readings.
Recording ball(double off_mm) {
  Recording r;
  for (int k = 0; k < 8; ++k) {
    RecordingRow row;
    row.feature = "BALL", row.touch = k + 1;
    row.normal = Vec3{k & 1 ? 0.48 : -0.48, k & 2 ? 0.6 : -0.6, 0.64};
    row.target_mm = Vec3{800, 500, -600} + 14.5 * *row.normal;
    row.position_mm = *row.target_mm + off_mm * *row.normal;
    row.reading_mm = row.position_mm - Vec3{3, -2, 1};
    row.time_s = k;
    r.rows.push_back(row);
  }
  return r;
}

}  // namespace

TEST_CASE("only effects within a signal period see what a touch itself adds to its raw reading") {
  const Machine machine = read_machine("coord3-mc16");
  const RecordedTouches clean = recorded_touches(ball(0), machine, "clean"), off = recorded_touches(ball(0.004), machine, "off");
  const Effect &scale = *find_effect("machine.scale"), &interpolation = *find_effect("machine.scale_interpolation");
  REQUIRE(off.touches.size() == 8);
  for (std::size_t i = 0; i < clean.touches.size(); ++i) {
    const RecordedTouch& t = off.touches[i];
    CHECK(norm(scene_for(scale, t).reading - scene_for(scale, clean.touches[i]).reading) < 1e-9);
    CHECK(norm(scene_for(interpolation, t).reading - scene_for(interpolation, clean.touches[i]).reading - 0.004 * t.scene.normal) < 1e-9);
  }
}
