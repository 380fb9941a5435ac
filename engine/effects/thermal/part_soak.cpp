// A part that has not yet taken the temperature that the compensation reckons with.
//
//   Tw(t) = Tinf + (T0 - Tinf) exp(-t / tau)
//   e = [ a (T0 - Tinf) (c - c0) + s ] exp(-t / tau),     r = n . e
//
// The part came warm (T0 > Tinf) or cold onto the machine; the compensation takes it as settled at
// Tinf. Its size drifts while the machine's origin does not. c0 is the origin of the part's frame,
// which is off by s at the start where the part is held elsewhere; t counts from the start of the program.
// Size: steel 11.5 um per metre and kelvin; 1 K left over 500 mm 5.75 um. A steel block of 40 mm in
// moving air: tau of 2 h.
// Source: linear expansion; lumped heat capacity (Newton's law of cooling).
// Confused with: thermal.part_expansion in a short program, thermal.drift when the part is small or
// touched on one side only.
#include "engine/effects/thermal/thermal.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kPartSoakParameters[] = {
    {.name = "start_K",
     .unit = "K",
     .help = "temperature of the part at the start minus the settled one",
     .typical = 1,
     .low = -50,
     .high = 50,
     .linear = true},
    {.name = "tau_s",
     .unit = "s",
     .help = "time constant of the part",
     .typical = 7200,
     .low = 1,
     .high = 1e6,
     .standard = 7200,
     .sought = Sought::time_constant},
    cte_parameter(11.5, "expansion coefficient of the part"),
    kHeldParameter,
    shift_parameter("shift_x_um", "um", "shift of the origin along the part's x at the start, if it is held elsewhere"),
    shift_parameter("shift_y_um", "um", "the same along y"),
    shift_parameter("shift_z_um", "um", "the same along z"),
};

Vec3 part_soak(const TouchScene& scene, const double* theta, const double*) {
  const double left = 1 - settled_share(scene.time_s, theta[1]);
  return isotropic_growth(scene, kPpm * theta[2] * theta[0] * left) +
      origin_shift(scene, theta[3], left * Vec3{theta[4], theta[5], theta[6]});
}

}  // namespace

constinit const Effect kPartSoak{
    .name = "thermal.part_soak",
    .title = "part not soaked",
    .help =
        "The part was put on the machine before it had the temperature of the room, and is taken "
        "as settled. Its lengths are wrong in proportion, and the error decays while the program "
        "runs: the first features are worst. The place of the part on the machine drifts "
        "only where it is held elsewhere than at its origin.",
    .source = "linear expansion with Newton's law of cooling",
    .separate = "repeat the first length at the end; wait; a sensor on the part",
    .influence = "part temperature",
    .stage = Stage::thermal,
    .needs = Covariate::normal | Covariate::part_frame | Covariate::time,
    .parameters = kPartSoakParameters,
    .displace = part_soak,
};

}  // namespace abbe
