// A stylus that has grown since its qualification.
//
//   d = + s a L DT(t),     DT(t) = DT (1 - exp(-t / tau))     s: unit vector from the tip to the
//   head
//
// L and a are the length and the expansion coefficient of the stylus in use. A longer stylus
// touches earlier: surfaces that face the head read too far out, those that face away too far in.
// Along s, so it turns with the head.
// Size: 100 mm steel 1.2 um/K, tungsten carbide 0.5, carbon fibre about 0.
// Source: linear expansion; lumped heat capacity for DT(t).
// Confused with: probe.stylus_length (the same shape, but that does not depend on time and
// material), thermal.drift along z with one orientation (rho 0.99).
#include "engine/effects/thermal/thermal.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kStylusGrowthParameters[] = {
    {.name = "rise_K",
     .unit = "K",
     .help = "settled temperature of the stylus minus that at its qualification",
     .typical = 1,
     .low = -20,
     .high = 20,
     .linear = true},
    {.name = "tau_s",
     .unit = "s",
     .help = "time constant of the rise; 0: warm from the start",
     .typical = 600,
     .low = 0,
     .high = 1e6,
     .standard = 600,
     .sought = Sought::time_constant},
};

Vec3 stylus_growth(const TouchScene& scene, const double* theta, const double*) {
  const StylusScene& stylus = scene.stylus;
  const double growth_mm = stylus.cte_per_K * stylus.length_mm * theta[0] * settled_share(scene.time_s, theta[1]);
  return growth_mm * stylus.to_head;
}

}  // namespace

constinit const Effect kStylusGrowth{
    .name = "thermal.stylus_growth",
    .title = "thermal growth of the stylus",
    .help =
        "The stylus is warmer than at its qualification and therefore longer. Surfaces that face "
        "the head read too far out. The direction turns with the head, and the size follows the "
        "length and the material of the stylus: long steel styli grow, carbon fibre does not.",
    .source = "linear expansion: 100 mm of steel 1.2 um/K, of tungsten carbide 0.5 um/K",
    .separate = "two head orientations; two stylus lengths or materials; a new qualification",
    .influence = "thermal drift",
    .stage = Stage::probe,
    .needs = Covariate::time | Covariate::head | Covariate::sensor,
    .parameters = kStylusGrowthParameters,
    .displace = stylus_growth,
};

}  // namespace abbe
