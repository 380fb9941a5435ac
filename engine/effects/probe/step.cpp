// A sudden change of one stylus: a joint that slips, a crash, a changed tip.
//
//   d = amplitude R_WR u   for t >= t0,   else 0
//
// The jump is fixed in the probe body, so it turns with the head, and it concerns one stylus only, or
// one of its qualified tips.
// Size: 0.5 um to millimetres.
// Confused with: part.shift and machine.step, when there is one orientation and one stylus.
#include "engine/effects/direction.hpp"
#include "engine/effects/probe/probe.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kProbeStepParameters[] = {
    {.name = "amplitude_um",
     .unit = "um",
     .help = "length of the jump vector of the tip, as the machine reads it",
     .typical = 2,
     .low = -10000,
     .high = 10000,
     .linear = true},
    kMomentParameter,
    {.name = "direction",
     .unit = "code",
     .help = "along which axis of the head's last link: 0 x, 1 y, 2 z (along the body, towards the "
             "head); 3 oblique: as azimuth and elevation say",
     .high = 3,
     .choices = kDirectionChoices,
     .sought = Sought::direction},
    {.name = "azimuth_deg",
     .unit = "deg",
     .help = "of an oblique direction: from x of the last link towards its y",
     .low = -360,
     .high = 360,
     .only_with = {"direction", "oblique"}},
    {.name = "elevation_deg",
     .unit = "deg",
     .help = "of an oblique direction: 90 is along the body, towards the head",
     .low = -90,
     .high = 90,
     .only_with = {"direction", "oblique"}},
    kSensorParameter,
    {.name = "tip",
     .unit = "code",
     .help = "which qualified tip: 0 the stylus in every orientation of the head; 1, 2, ...: only in "
             "the one whose sensor comes first, second, ... (an arm of a star, an orientation "
             "qualified anew)",
     .high = 1000,
     .sought = Sought::tip},
};

Vec3 probe_step(const TouchScene& scene, const double* theta, const double*) {
  if (scene.time_s < theta[1] || !concerns(scene.stylus, theta[5])) return {};
  const int tip = static_cast<int>(theta[6]);
  if (tip != 0 && tip != scene.stylus.tip_ordinal) return {};
  return theta[0] * kUm * (scene.stylus.R_WR * chosen_direction(theta + 2));
}

}  // namespace

constinit const Effect kProbeStep{
    .name = "probe.step",
    .title = "sudden change of a stylus",
    .help =
        "From one moment on, the tip of a stylus sits elsewhere: a loose joint, a light crash, a "
        "changed tip without a new qualification. All later touches with this stylus jump by the "
        "same vector of the probe body; other styli do not.",
    .source = "change of the qualified tip offset (ISO 10360-5 location tests)",
    .separate = "the reference sphere before and after, with this stylus and with another",
    .influence = "probe repeatability",
    .stage = Stage::probe,
    .needs = Covariate::time | Covariate::head | Covariate::sensor,
    .parameters = kProbeStepParameters,
    .displace = probe_step,
};

}  // namespace abbe
