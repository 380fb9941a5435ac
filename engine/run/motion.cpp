#include "engine/run/motion.hpp"

#include <algorithm>
#include <cmath>

namespace abbe {

MotionSettings default_motion(const Machine& machine) {
  MotionSettings s;
  s.positioning_mm_s = machine.motion.speed_mm_s;
  s.measuring_mm_s = machine.motion.probing_speed_mm_s;
  s.positioning_mm_s2 = s.measuring_mm_s2 = machine.motion.acceleration_mm_s2;
  return s;
}

void apply(MotionSettings& s, const plan::SetMotion& set, const Machine& machine) {
  const auto of = [&](double full) { return set.percent ? set.value / 100 * full : set.value; };
  using enum plan::MotionSetting;
  switch (set.setting) {
    case approach: s.approach_mm = set.value; break;
    case retract: s.retract_mm = set.value; break;
    case positioning_speed: s.positioning_mm_s = of(machine.motion.speed_mm_s); break;
    case measuring_speed: s.measuring_mm_s = of(machine.motion.probing_speed_mm_s); break;
    case positioning_acceleration: s.positioning_mm_s2 = of(machine.motion.acceleration_mm_s2); break;
    case measuring_acceleration: s.measuring_mm_s2 = of(machine.motion.acceleration_mm_s2); break;
    // These say how the controller searches, keeps clear or rounds corners; they change neither when nor how
    // a touch happens.
    case search:
    case clearance:
    case depth:
    case scan_speed:
    case fly_radius: break;
  }
}

double move_time_s(double distance_mm, double speed_mm_s, double acceleration_mm_s2) {
  const double ramps_mm = speed_mm_s * speed_mm_s / acceleration_mm_s2;
  if (distance_mm >= ramps_mm) return distance_mm / speed_mm_s + speed_mm_s / acceleration_mm_s2;
  return 2 * std::sqrt(distance_mm / acceleration_mm_s2);
}

void Motion::travel(const Vec3& by) {
  for (int axis = 0; axis < 3; ++axis) {
    // Rounding in a transformed target is no motion of the axis.
    if (std::fabs(by[axis]) < 1e-6) continue;
    const int sense = by[axis] > 0 ? 1 : -1;
    since_reversal_mm_[axis] = std::fabs(by[axis]) + (sense == sense_[axis] ? since_reversal_mm_[axis] : 0.0);
    sense_[axis] = sense;
  }
  position_ += by;
}

void Motion::move_to(const Vec3& target) {
  const Vec3 by = target - position_;
  time_s_ += move_time_s(norm(by), settings_.positioning_mm_s, settings_.positioning_mm_s2);
  travel(by);
}

TouchMotion Motion::touch(const Vec3& contact, const Vec3& normal) {
  move_to(contact + settings_.approach_mm * normal);
  TouchMotion m;
  const double distance = settings_.approach_mm, acceleration = settings_.measuring_mm_s2;
  m.speed_mm_s = std::min(settings_.measuring_mm_s, std::sqrt(2 * acceleration * distance));
  m.acceleration_mm_s2 = acceleration;
  if (m.speed_mm_s > 0) m.settled_s = (distance - m.speed_mm_s * m.speed_mm_s / (2 * acceleration)) / m.speed_mm_s;
  time_s_ += m.speed_mm_s / acceleration + m.settled_s;
  travel(-(settings_.approach_mm * normal));
  m.time_s = time_s_;
  m.travel = -normal;
  std::copy(sense_, sense_ + 3, m.sense);
  std::copy(since_reversal_mm_, since_reversal_mm_ + 3, m.since_reversal_mm);
  time_s_ += kTriggerDwell_s;
  move_to(contact + settings_.retract_mm * normal);
  return m;
}

}  // namespace abbe
