// Delay between contact and the latching of the scales.
//
//   d = (v - v_q) t a,   so   r = - (v - v_q) t  for an approach a = -n
//
// While the signal is on its way the machine moves on along a. The qualification, at a speed v_q,
// stores the delay as a smaller tip: of a delay t that is as it was then, only probing at another
// speed shows. Of one that changed since, t is the change, and v_q counts as 0.
// Size: 1 ms at 8 mm/s is 8 um.
// Sources: Ling & Wilkin, NIST IR (1999): error proportional to feed; user guides ask to qualify at
// the gauging speed.
// Confused with: probe.tip_radius as long as there is one speed (rho 1.00; 0.33 with a second one).
#include "engine/effects/probe/probe.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kTriggerDelayParameters[] = {
    {.name = "delay_ms",
     .unit = "ms",
     .help = "delay at the trigger, or how much longer it is than at the qualification; positive: late",
     .typical = 0.2,
     .low = -100,
     .high = 100,
     .linear = true},
    {.name = "qualified_at_mm_s",
     .unit = "mm/s",
     .help =
         "the speed of the qualification, at which the delay shows nothing; 0: it changed since, and shows at all speeds",
     .high = 1000,
     .sought = Sought::speed},
};

Vec3 trigger_delay(const TouchScene& scene, const double* theta, const double*) {
  const double delay_s = theta[0] * 1e-3;
  return delay_s * (scene.speed_mm_s - theta[1]) * approach(scene);
}

}  // namespace

constinit const Effect kTriggerDelay{
    .name = "probe.trigger_delay",
    .title = "trigger delay times probing speed",
    .help =
        "The scales are read a little after the contact, and the machine has moved on by speed "
        "times delay: the surface seems too far in, in proportion to the probing speed. The "
        "qualification takes it for a smaller tip, so that nothing shows at its speed. At one "
        "speed it cannot be told from a tip radius error.",
    .source =
        "Ling & Wilkin, NIST IR (1999): error proportional to feed; touch-trigger probe user "
        "guides: qualify at the gauging speed",
    .separate = "repeat at a second probing speed",
    .influence = "trigger delay",
    .stage = Stage::probe,
    .needs = Covariate::normal | Covariate::speed,
    .parameters = kTriggerDelayParameters,
    .displace = trigger_delay,
};

}  // namespace abbe
