// Random scenes of a touch on a machine of 1600 x 1000 x 800 mm, for properties that must hold on
// all.
#pragma once

#include <cmath>
#include <cstdint>

#include "engine/effects/effect.hpp"

namespace abbe::effects_test {

/// SplitMix64 (Steele, Lea, Flood 2014): the same scenes in every run, on every machine.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : state_(seed) {}
  double between(double low, double high) {
    std::uint64_t x = state_ += 0x9E3779B97F4A7C15u;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    x ^= x >> 31;
    return low + (high - low) * (static_cast<double>(x >> 11) * 0x1p-53);
  }
  int choice(int from, int to) { return static_cast<int>(std::floor(between(from, to + 1))); }
  /// Irwin-Hall: close enough to a standard normal number.
  double normal() {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += between(0, 1);
    return sum;
  }
  Vec3 inside(double half) { return {between(-half, half), between(-half, half), between(-half, half)}; }
  Vec3 unit_vector() { return unit(inside(1) + Vec3{1e-3, 0, 0}); }
  Mat3 turn() { return rotation(unit_vector(), between(-kPi, kPi)); }

 private:
  std::uint64_t state_;
};

inline StylusScene random_stylus(Numbers& random) {
  StylusScene s;
  s.name = "S";
  s.head_a_rad = random.between(0, kPi / 2);
  s.head_b_rad = random.between(-kPi, kPi);
  s.R_WR = rotation({0, 0, 1}, s.head_b_rad) * rotation({0, 1, 0}, -s.head_a_rad);
  s.to_head = s.R_WR.cz;
  s.length_mm = random.between(20, 300);
  s.tip_from_mount_mm = -s.length_mm * s.to_head;
  s.radius_mm = random.between(0.25, 4);
  s.shaft_diameter_mm = s.length_mm * random.between(0.03, 0.08);
  s.young_MPa = random.between(2e5, 6.2e5);
  s.cte_per_K = random.between(0, 12e-6);
  s.indexed = true;
  s.ordinal = random.choice(1, 3);
  return s;
}

inline Temperatures random_temperatures(Numbers& random) {
  Temperatures t;
  t.part = random.between(15, 25);
  t.air = random.between(15, 25);
  for (double& scale : t.scale) scale = random.between(15, 25);
  t.table_top_minus_bottom_K = random.between(-1, 1);
  t.bridge_gradient_K = random.between(-1, 1);
  t.legs_difference_K = random.between(-1, 1);
  return t;
}

inline TouchScene random_scene(Numbers& random) {
  TouchScene s;
  s.stylus = random_stylus(random);
  s.temperature = random_temperatures(random);
  s.travel_length_mm = {1600, 1000, 800};
  s.reading = {random.between(0, 1600), random.between(0, 1000), random.between(-800, 0)};
  s.point = s.reading + s.stylus.tip_from_mount_mm;
  const Vec3 origins[] = {{0, 0, -950}, {0, 0, 135}, {95, -30, 400}};
  for (int axis = 0; axis < 3; ++axis) s.lever_mm[axis] = s.stylus.tip_from_mount_mm + origins[axis];
  s.normal = random.unit_vector();
  s.travel = unit(-s.normal + random.inside(0.1));
  const Mat3 R_WP = random.turn();
  s.on_part = transpose(R_WP) * (s.point - Vec3{800, 500, -600});
  s.normal_on_part = transpose(R_WP) * s.normal;
  s.time_s = random.between(0, 7200);
  s.speed_mm_s = random.between(1, 10);
  s.acceleration_mm_s2 = random.between(50, 1000);
  s.settled_s = random.between(0.02, 1);
  for (int& sense : s.sense) sense = random.choice(0, 1) == 0 ? -1 : 1;
  for (double& mm : s.since_reversal_mm) mm = random.between(0, 5);
  s.load_kg = random.between(0, 1000);
  s.touch = random.choice(0, 1000);
  s.feature = random.choice(0, 50);
  s.visit = random.choice(0, 5);
  return s;
}

}  // namespace abbe::effects_test
