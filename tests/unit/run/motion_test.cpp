#include "engine/run/motion.hpp"

#include <doctest/doctest.h>

using namespace abbe;

namespace {

MotionSettings settings() {
  MotionSettings s;
  s.approach_mm = 4, s.retract_mm = 2;
  s.positioning_mm_s = 100, s.measuring_mm_s = 5;
  s.positioning_mm_s2 = s.measuring_mm_s2 = 500;
  return s;
}

}  // namespace

TEST_CASE("a long move has ramps and a steady part, a short one only ramps") {
  CHECK(move_time_s(100, 100, 500) == doctest::Approx(100 / 100.0 + 100 / 500.0));
  CHECK(move_time_s(5, 100, 500) == doctest::Approx(2 * std::sqrt(5 / 500.0)));
  CHECK(move_time_s(20, 100, 500) == doctest::Approx(0.4));  // exactly the two ramps: 100^2 / 500 = 20 mm
  CHECK(move_time_s(0, 100, 500) == 0);
}

TEST_CASE("a touch adds positioning, approach, dwell and retract to the clock") {
  Motion motion({0, 0, 0}, settings());
  const TouchMotion touch = motion.touch({100, 0, 0}, {-1, 0, 0});
  CHECK(touch.speed_mm_s == 5);
  CHECK(touch.travel == Vec3{1, 0, 0});
  // 96 mm at 100 mm/s; 5 mm/s reached after 0.025 mm, the other 3.975 mm at 5 mm/s.
  const double positioning = 96 / 100.0 + 0.2, approach = 0.01 + 3.975 / 5;
  CHECK(touch.settled_s == doctest::Approx(3.975 / 5));
  CHECK(touch.time_s == doctest::Approx(positioning + approach));
  CHECK(motion.time_s() == doctest::Approx(touch.time_s + kTriggerDwell_s + 2 * std::sqrt(2 / 500.0)));
}

TEST_CASE("an approach shorter than the ramp is slower than the measuring speed") {
  MotionSettings s = settings();
  s.measuring_mm_s = 100;
  Motion motion({0, 0, 0}, s);
  const TouchMotion touch = motion.touch({50, 0, 0}, {-1, 0, 0});
  CHECK(touch.speed_mm_s == doctest::Approx(std::sqrt(2 * 500.0 * 4)));
  CHECK(touch.settled_s == doctest::Approx(0));
}

TEST_CASE("axes remember their last sense and the travel since the reversal") {
  Motion motion({0, 0, 0}, settings());
  motion.move_to({10, -20, 0});
  motion.move_to({30, -10, 0});
  const TouchMotion touch = motion.touch({30, -10, -50}, {0, 0, 1});
  CHECK(touch.sense[0] == 1);
  CHECK(touch.since_reversal_mm[0] == doctest::Approx(30));
  CHECK(touch.sense[1] == 1);
  CHECK(touch.since_reversal_mm[1] == doctest::Approx(10));
  CHECK(touch.sense[2] == -1);
  CHECK(touch.since_reversal_mm[2] == doctest::Approx(50));
}

TEST_CASE("settings of the program win, percentages refer to the machine") {
  Machine machine;
  machine.motion = {200, 8, 1000};
  MotionSettings s = default_motion(machine);
  CHECK(s.positioning_mm_s == 200);
  apply(s, {plan::MotionSetting::positioning_speed, 50, true}, machine);
  CHECK(s.positioning_mm_s == 100);
  apply(s, {plan::MotionSetting::measuring_speed, 3, false}, machine);
  CHECK(s.measuring_mm_s == 3);
}
