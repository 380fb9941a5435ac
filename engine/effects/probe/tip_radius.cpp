// A tip that is larger or smaller than assumed.
//
//   r = + dr
//
// dr: true minus assumed effective radius. The effective radius is what the qualification found:
// half the ball's diameter less the mean pretravel, so an error of either is this effect. Outer
// sizes read 2 dr too large, inner sizes 2 dr too small.
// Size: 0.1 to 3 um; a good reference sphere alone has U = 0.07 um + 1.1e-6 D (NPL).
// Confused with: probe.trigger_delay at a single probing speed (exactly), machine.backlash when
// each touch runs along -n.
#include "engine/effects/probe/probe.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kTipRadiusParameters[] = {
    {.name = "amplitude_um",
     .unit = "um",
     .help = "true minus assumed effective radius; positive: the tip is larger than assumed",
     .typical = 1,
     .low = -1000,
     .high = 1000,
     .linear = true},
    kSensorParameter,
};

Vec3 tip_radius(const TouchScene& scene, const double* theta, const double*) {
  return concerns(scene.stylus, theta[1]) ? along_normal(scene, theta[0] * kUm) : Vec3{};
}

}  // namespace

constinit const Effect kTipRadius{
    .name = "probe.tip_radius",
    .title = "tip radius other than assumed",
    .help =
        "The effective radius of the tip differs from the one that the qualification stored: wrong "
        "size of the reference sphere, wear, dirt, or another mean pretravel than at the "
        "qualification. Outer features become larger by twice the error, inner ones smaller; "
        "positions and distances between like surfaces do not change.",
    .source =
        "Estler et al., Precision Engineering 19 (1996); NPL calibration of reference spheres, U = "
        "0.07 um + 1.1e-6 D",
    .separate =
        "a second probing speed (tells it from the trigger's delay); an inner and an outer length, "
        "or a length between opposite faces (tells it from a scale); the certificate of the ball "
        "(tells the radius from the mean pretravel)",
    .influence = "tip size and form",
    .stage = Stage::probe,
    .needs = 0u | Covariate::normal,
    .parameters = kTipRadiusParameters,
    .displace = tip_radius,
};

}  // namespace abbe
