// Sag of a lying stylus, extension or head under its own weight.
//
//   d = [ bending (L/L0)^3 + joint (L/L0)^2 ] Z_perp,   Z_perp = Z - (Z.s) s
//
// A load m g at the end of a bar of length L bends it by m g L^3/(3 E I) and turns the joint by m g
// L theta_k, moving the tip by m g L^2 theta_k; both in proportion to sin A, across the stylus and
// downwards. The true tip is lower than computed, so the machine reads too high: d points up.
// |Z_perp| = |sin A|, so at A = 90 the sag is vertical; in between the horizontal part is kept too.
// `bending_um`, `joint_um`: the two at A = 90 for a bar of `at_length_mm`.
// Size: 1 to 5 um for long carbon-fibre bars. An orientation that is qualified contains its sag; it
// shows when the stylus changed since, or the offset is computed.
// Confused with: head.axis_errors (its first harmonic of A).
#include "engine/effects/head/head.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kHeadSagParameters[] = {
    {.name = "bending_um",
     .unit = "um",
     .help = "sag of the tip by bending of the bar, lying level (A = 90), at at_length_mm",
     .typical = 1.5,
     .low = -200,
     .high = 200,
     .linear = true},
    {.name = "joint_um",
     .unit = "um",
     .help = "sag of the tip by the turn of the joint, lying level (A = 90), at at_length_mm",
     .typical = 1.5,
     .low = -200,
     .high = 200,
     .linear = true},
    {.name = "at_length_mm",
     .unit = "mm",
     .help = "distance from the head's centre to the tip for which the sags are given",
     .typical = 200,
     .low = 10,
     .high = 1000,
     .standard = 200},
};

Vec3 head_sag(const TouchScene& scene, const double* theta, const double*) {
  constexpr Vec3 kUp{0, 0, 1};
  const double growth = scene.stylus.length_mm / theta[2];
  const double sag_mm = (theta[0] * growth + theta[1]) * growth * growth * kUm;
  return sag_mm * perpendicular_part(kUp, scene.stylus.to_head);
}

}  // namespace

constinit const Effect kHeadSag{
    .name = "head.sag",
    .title = "sag of a lying stylus or extension",
    .help =
        "A long bar bends under its weight and turns its joint when it does not hang straight "
        "down: the tip is lower than computed and the machine reads too high. Nothing at A = 0, "
        "most at A = 90, on either side alike. It grows with the second and third power of the "
        "length.",
    .source = "Euler-Bernoulli cantilever with an elastic joint",
    .separate =
        "A = 0 against A = +90 and A = -90 on a fixed sphere; two lengths or masses of the "
        "extension",
    .influence = "head geometry and qualification",
    .stage = Stage::head,
    .needs = Covariate::head | Covariate::sensor,
    .parameters = kHeadSagParameters,
    .displace = head_sag,
};

}  // namespace abbe
