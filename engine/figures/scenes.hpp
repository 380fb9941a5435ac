// The standard scenes of a signature: one plain touch, and the ways to vary it one quantity at a
// time. Every way belongs to a covariate of the registry (effects/effect.hpp), so what an effect
// says it needs chooses what its figure shows.
//
// The plain touch happens in the middle of the volume of the shipped machine, an hour after the
// start, on a part of 500 kg, with everything at 22 degrees C and a straight stylus of 100 mm below
// a head of two axes. Frames and signs are those of docs/notation.md.
#pragma once

#include <span>
#include <string_view>

#include "engine/effects/effect.hpp"
#include "engine/machine/machine.hpp"

namespace abbe {

/// What can be varied; everything else of a scene follows from it.
struct StandardTouch {
  Vec3 reading_mm{800, 500, -400};
  Vec3 on_part_mm{150, 100, 60};
  double azimuth_deg = 0,
         elevation_deg = 0;  ///< of the normal: from x towards y, from there towards z
  double askew_deg = 0;      ///< between the approach and the normal reversed
  double time_s = 3600;
  double speed_mm_s = 8, acceleration_mm_s2 = 300, settled_s = 0.05;
  double path_mm = 10;  ///< of every axis since it began to move forward; it turns back at kTurn_mm
  double head_a_deg = 0, head_b_deg = 0;
  double stylus_mm = 100, tip_radius_mm = 1;
  double part_C = 22, scale_C = 22, air_C = 22;
  double gradient_K = 0;  ///< of table, bridge and legs
  double load_kg = 500;
  double visit = 0;
};
inline constexpr double kTurn_mm = 20;

/// The scene of a touch on this machine.
TouchScene scene_of(const StandardTouch&, const Machine&);

/// One quantity of the touch and the range in which a figure varies it.
struct Sweep {
  std::string_view title;  ///< "reading of x, mm"
  Covariate needs;
  double from, to;
  double low, high;  ///< two typical values, for two lines
  void (*set)(StandardTouch&, double);
  bool turns_normal = false;
};

/// All of them; those that tell most about an effect that depends on several stand first.
std::span<const Sweep> sweeps();

}  // namespace abbe
