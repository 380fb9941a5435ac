// Lost motion of an axis at reversal.
//
//   d_i = (b/2) sigma g(s),    g(s) = 1 - 2 exp(-s / memory)
//
// sigma: sense of the axis' last motion; s: its travel since the sense changed. The scale leads the
// carriage by half the lost motion. With memory 0 the sign flips at once; a drive that winds up
// over some length (friction, cable chain) forgets the old side gradually: g runs from -1 just
// after the reversal to +1, continuously, as the play operator asks, but smoothly.
// Size: b = 0.2 to 2 um.
// Confused with: machine.dynamics (rho 0.7 to 0.99) and probe.tip_radius, as the direction of
// probing fixes the sense.
#include "engine/effects/machine/machine.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kBacklashParameters[] = {
    {.name = "backlash_um",
     .unit = "um",
     .help = "difference of the readings between the two senses of motion",
     .typical = 1,
     .low = -100,
     .high = 100,
     .linear = true},
    axis_parameter("the axis: 0 x, 1 y, 2 z"),
    {.name = "memory_mm",
     .unit = "mm",
     .help = "travel after a reversal over which the old side is forgotten; 0: at once",
     .typical = 0,
     .low = 0,
     .high = 100},
};

Vec3 backlash(const TouchScene& scene, const double* theta, const double*) {
  const int axis = code(theta[1]);
  const double forgotten = theta[2] > 0 ? 1 - 2 * std::exp(-scene.since_reversal_mm[axis] / theta[2]) : 1;
  return 0.5 * theta[0] * kUm * scene.sense[axis] * forgotten * axis_vector(axis);
}

}  // namespace

constinit const Effect kBacklash{
    .name = "machine.backlash",
    .title = "backlash of an axis",
    .help =
        "The reading of an axis depends on the sense in which it moved last: half the backlash too "
        "far in the direction of motion. Probing opposite faces makes the senses differ, so it "
        "looks like a tip radius along that axis.",
    .source = "ISO 230-2 reversal error; ISO 10360-2; play operator (Krasnosel'skii & Pokrovskii)",
    .separate =
        "touch the same face with the other axes arriving from either side; reverse the moves "
        "before the approach",
    .influence = "dynamics and backlash",
    .stage = Stage::scale,
    .needs = 0u | Covariate::direction,
    .parameters = kBacklashParameters,
    .displace = backlash,
};

}  // namespace abbe
