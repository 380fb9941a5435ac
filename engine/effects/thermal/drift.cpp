// Warm-up: the whole frame of the machine moves against the part, and settles.
//
//   d(t) = amplitude u [ (1 - q) (1 - exp(-t / tau)) + q (1 - exp(-t / tau2)) ]
//
// u: direction in W. One exponential for one body that takes up the room's temperature; a second,
// slow one with the share q for the table, which follows much later. t counts from the start of the
// program, where d = 0. The same for every touch: only time matters. tau = rho cp V / (h A):
// aluminium wall of 10 mm 1.4 h, granite table of 0.2 m 12 h. Size: 1 to 10 um.
// Source: lumped heat capacity (Newton's law of cooling), a step of the surroundings.
// Confused with: a linear drift (rho 0.87 to 0.96 in 1.5 h), position and orientation in a program
// that visits them in order, thermal.ram_growth with one height and one orientation (rho 0.99).
#include "engine/effects/direction.hpp"
#include "engine/effects/thermal/thermal.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kThermalDriftParameters[] = {
    {.name = "amplitude_um",
     .unit = "um",
     .help = "length of the whole translation, from the start to settled",
     .typical = 3,
     .low = -1000,
     .high = 1000,
     .linear = true},
    kDirectionParameter,
    kAzimuthParameter,
    kElevationParameter,
    {.name = "tau_s",
     .unit = "s",
     .help = "time constant",
     .typical = kAluminiumWall_s,
     .low = 1,
     .high = 1e6,
     .standard = kAluminiumWall_s,
     .sought = Sought::time_constant},
    {.name = "second_share",
     .unit = "1",
     .help = "share of a second, slower exponential; 0: one exponential",
     .high = 1},
    {.name = "second_tau_s",
     .unit = "s",
     .help = "time constant of the second exponential",
     .typical = kGraniteTable_s,
     .low = 1,
     .high = 1e6,
     .standard = kGraniteTable_s},
};

Vec3 thermal_drift(const TouchScene& scene, const double* theta, const double*) {
  double reached = settled_share(scene.time_s, theta[4]);
  if (theta[5] != 0) reached += theta[5] * (settled_share(scene.time_s, theta[6]) - reached);
  return theta[0] * kUm * reached * chosen_direction(theta + 1);
}

}  // namespace

constinit const Effect kThermalDrift{
    .name = "thermal.drift",
    .title = "warm-up drift",
    .help =
        "After switching on, or after a step of the room's temperature, the machine moves "
        "against the part and settles exponentially. All touches are displaced alike, whatever "
        "they touch; only the time since the start matters. Distances between touches made far "
        "apart in time are wrong by the drift in between.",
    .source =
        "lumped heat capacity: tau = density x heat capacity x volume / (transfer coefficient x "
        "surface)",
    .separate =
        "return to a fixed reference sphere every ten minutes; random order of the features; "
        "measure longer than two time constants",
    .influence = "thermal drift",
    .stage = Stage::thermal,
    .needs = 0u | Covariate::time,
    .parameters = kThermalDriftParameters,
    .displace = thermal_drift,
};

}  // namespace abbe
