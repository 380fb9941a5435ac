// The part moves on the table, at one moment of the measurement.
//
//   d = amplitude u    for t >= t0,   else 0
//
// A clamp slips, or the probe pushes a light part. Everything touched after t0 is displaced by one
// vector u of W, whatever stylus or orientation touches it. A new alignment after t0 removes it.
// Size: 0.5 um to millimetres. Source: a rigid translation.
// Confused with: machine.step in time (the machine jumps: the part's own alignment cannot tell; a
// reference sphere fixed on the table can), probe.step when there is one stylus with one
// orientation, thermal.drift with a short time constant.
#include "engine/effects/direction.hpp"
#include "engine/effects/part/part.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kPartShiftParameters[] = {
    {.name = "amplitude_um",
     .unit = "um",
     .help = "length of the jump vector of the part",
     .typical = 2,
     .low = -10000,
     .high = 10000,
     .linear = true},
    kMomentParameter,
    kDirectionParameter,
    kAzimuthParameter,
    kElevationParameter,
};

Vec3 part_shift(const TouchScene& scene, const double* theta, const double*) {
  if (scene.time_s < theta[1]) return {};
  return theta[0] * kUm * chosen_direction(theta + 2);
}

}  // namespace

constinit const Effect kPartShift{
    .name = "part.shift",
    .title = "part moved during the measurement",
    .help =
        "From one moment on the part lies elsewhere: a clamp slipped or the probe pushed it. All "
        "later touches jump by the same vector, with every stylus and in every orientation, "
        "until the part is aligned again. Distances between features from before and after are "
        "wrong by the jump.",
    .source = "rigid translation of the part",
    .separate =
        "return to the features of the alignment at the end; a reference sphere fixed on the "
        "table tells the part from the machine",
    .influence = "fixturing",
    .stage = Stage::part,
    .needs = 0u | Covariate::time,
    .parameters = kPartShiftParameters,
    .displace = part_shift,
};

}  // namespace abbe
