// The motion model: when, how fast and in which direction the machine touches. It gives every touch the
// covariates that effects need and the run its cycle time. Deliberately plain, and documented in
// docs/physics.md:
//
// - A move is a straight line with a trapezoidal speed profile at the positioning speed and acceleration.
// - A touch: move to the approach distance above the point; drive towards it at the measuring speed, starting from rest; at
//   contact stop; withdraw by the retract distance.
// - Indexing the head takes kIndexing_s, a sensor that is selected again takes nothing.
//
// FEDRAT, ACLRAT and SNSET of the program win over the machine file.
#pragma once

#include "engine/machine/machine.hpp"
#include "engine/plan/plan.hpp"

namespace abbe {

inline constexpr double kIndexing_s = 3.0;      ///< typical of indexable heads (90 degrees, unlock to lock)
inline constexpr double kTriggerDwell_s = 0.1;  ///< stop, latch the scales, turn round

struct MotionSettings {
  double approach_mm = 5, retract_mm = 5;
  double positioning_mm_s = 0, measuring_mm_s = 0;
  double positioning_mm_s2 = 0, measuring_mm_s2 = 0;
};
MotionSettings default_motion(const Machine&);
/// Applies one setting of the program; `percent` values are shares of the machine's own figure.
void apply(MotionSettings&, const plan::SetMotion&, const Machine&);

/// What the motion is at the moment of a touch.
struct TouchMotion {
  double time_s = 0, speed_mm_s = 0, acceleration_mm_s2 = 0, settled_s = 0;
  Vec3 travel;  ///< unit vector just before contact
  int sense[3] = {1, 1, 1};
  double since_reversal_mm[3] = {0, 0, 0};
};

/// Position, clock and axis senses of one machine that follows a program. W, mm, s.
class Motion {
 public:
  Motion(const Vec3& start, const MotionSettings& settings) : settings_(settings), position_(start) {}

  MotionSettings& settings() { return settings_; }
  const MotionSettings& settings() const { return settings_; }
  double time_s() const { return time_s_; }
  const Vec3& position() const { return position_; }
  void move_to(const Vec3& target);
  /// The tip centre meets the surface at `contact`, coming along -normal.
  TouchMotion touch(const Vec3& contact, const Vec3& normal);
  void index_head() { time_s_ += kIndexing_s; }

 private:
  void travel(const Vec3& by);

  MotionSettings settings_;
  Vec3 position_;
  double time_s_ = 0;
  int sense_[3] = {1, 1, 1};
  double since_reversal_mm_[3] = {0, 0, 0};
};

/// Time of a straight move from rest to rest, s.
double move_time_s(double distance_mm, double speed_mm_s, double acceleration_mm_s2);

}  // namespace abbe
