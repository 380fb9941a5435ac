// A ram that grows below its scale's reading head.
//
//   d_z = + a DT(t) (L0 - s_z),     DT(t) = DT (1 - exp(-t / tau))
//
// The ram hangs down from the reading head of z; what hangs is L0 at reading zero and gets longer
// as the reading falls. Warmer than assumed it is longer, the tip is lower than the machine
// believes, and surfaces read too high: +z. In z only, growing with the extension. DT is what the
// compensation of the scale does not know: the rise of the ram above the z scale.
// Size: aluminium ram 800 mm out, 0.5 K: 9.2 um, less the share of the scale.
// Source: linear expansion; lumped heat capacity for DT(t).
// Confused with: thermal.drift along z when only one height is measured (rho 0.99; 0.64 with
// several heights and orientations); once settled, with the scale of z.
#include "engine/effects/thermal/thermal.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kRamGrowthParameters[] = {
    {.name = "rise_K",
     .unit = "K",
     .help = "settled rise of the ram's temperature above what is compensated",
     .typical = 0.5,
     .low = -20,
     .high = 20,
     .linear = true},
    {.name = "tau_s",
     .unit = "s",
     .help = "time constant of the rise; 0: warm from the start",
     .typical = kAluminiumWall_s,
     .low = 0,
     .high = 1e6,
     .standard = kAluminiumWall_s,
     .sought = Sought::time_constant},
    cte_parameter(23.1, "expansion coefficient of the ram"),
    {.name = "length_at_zero_mm",
     .unit = "mm",
     .help = "from the reading head of z down to the head's mount, at reading zero",
     .typical = 400,
     .low = 0,
     .high = 10000,
     .standard = 400},
};

Vec3 ram_growth(const TouchScene& scene, const double* theta, const double*) {
  const double rise_K = theta[0] * settled_share(scene.time_s, theta[1]);
  return {0, 0, theta[2] * kPpm * rise_K * (theta[3] - scene.reading.z)};
}

}  // namespace

constinit const Effect kRamGrowth{
    .name = "thermal.ram_growth",
    .title = "thermal growth of the ram",
    .help =
        "The ram warms up, by its drives or by the air, and the scale does not see it. The part "
        "of the ram below the reading head grows, the tip is lower than the machine believes, "
        "and all surfaces read too high; the more, the further the ram is out.",
    .source = "linear expansion of the free length of the ram; aluminium 23.1 ppm/K",
    .separate = "the same artefact at several heights; a second head orientation; a sensor on the ram",
    .influence = "thermal drift",
    .stage = Stage::thermal,
    .needs = Covariate::position | Covariate::time,
    .parameters = kRamGrowthParameters,
    .displace = ram_growth,
};

}  // namespace abbe
