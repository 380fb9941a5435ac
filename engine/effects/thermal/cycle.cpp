// A room whose control makes the temperature swing.
//
//   d(t) = amplitude u sin(2 pi t / period + phase)
//
// u: direction in W. The frame follows the air in part and with a lag; what is left is a sine with
// the period of the control, 10 to 60 minutes. Size: some tenths of a micrometre to some
// micrometres. Shows as one line in the spectrum of residuals against time.
// Source: first-order response to a periodic surrounding; ISO/TR 16015 for the temperature
// variation error.
// Confused with: the pattern of the measuring sequence when it repeats with a similar period
// (aliasing), thermal.drift in a program that is shorter than a quarter of the period.
#include "engine/effects/direction.hpp"
#include "engine/effects/thermal/thermal.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kThermalCycleParameters[] = {
    {.name = "amplitude_um",
     .unit = "um",
     .help = "amplitude of the translation; peak to valley is twice this",
     .typical = 1,
     .low = -1000,
     .high = 1000,
     .linear = true},
    {.name = "period_s",
     .unit = "s",
     .help = "period of the room's control",
     .typical = 1200,
     .low = 120,  // what is faster no frame follows
     .high = 1e6,
     .standard = 1200,
     .sought = Sought::period},
    {.name = "phase_deg",
     .unit = "deg",
     .help = "phase at the start of the program",
     .low = -360,
     .high = 360,
     .sought = Sought::phase},
    kDirectionParameter,
    kAzimuthParameter,
    kElevationParameter,
};

Vec3 thermal_cycle(const TouchScene& scene, const double* theta, const double*) {
  const double swing = std::sin(2 * kPi * scene.time_s / theta[1] + theta[2] * kDegree);
  return theta[0] * kUm * swing * chosen_direction(theta + 3);
}

}  // namespace

constinit const Effect kThermalCycle{
    .name = "thermal.cycle",
    .title = "swing with the room's temperature control",
    .help =
        "The air conditioning switches on and off, and the machine breathes with it: all touches "
        "are displaced by the same sine of time. A feature that takes longer than a quarter of "
        "the period gets a false form; short ones get a false place.",
    .source =
        "first-order response to a periodic surrounding; ISO/TR 16015, temperature variation "
        "error",
    .separate =
        "log the air temperature; random order of the features, so that the sequence cannot "
        "repeat with the period",
    .influence = "thermal drift",
    .stage = Stage::thermal,
    .needs = 0u | Covariate::time,
    .parameters = kThermalCycleParameters,
    .displace = thermal_cycle,
};

}  // namespace abbe
