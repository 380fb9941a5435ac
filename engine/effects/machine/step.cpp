// A sudden change of the machine: a crash, a re-levelling, a bearing that jumps.
//
//   d = amplitude u   when t >= t0, or when the reading of an axis >= position
//
// u: direction in W. `along` chooses between a moment (time) and a place (x, y, z).
// Size: 0.5 to 50 um.
// Confused with: part.shift, which moves with the part (same shape while the part stays),
// probe.step with one orientation and one stylus, thermal.drift with a short time constant.
#include "engine/effects/direction.hpp"
#include "engine/effects/machine/machine.hpp"

namespace abbe {
namespace {

constexpr std::string_view kMachineStepChoices[] = {"time", "x", "y", "z"};

constexpr EffectParameter kMachineStepParameters[] = {
    {.name = "amplitude_um",
     .unit = "um",
     .help = "length of the jump vector, as the machine reads it",
     .typical = 2,
     .low = -1000,
     .high = 1000,
     .linear = true},
    {.name = "t0_s",
     .unit = "s",
     .help = "when, since the start of the program (along = time)",
     .typical = 600,
     .low = 0,
     .high = 1e7,
     .only_with = {"along", "time"},
     .sought = Sought::moment},
    kDirectionParameter,
    kAzimuthParameter,
    kElevationParameter,
    {.name = "along",
     .unit = "code",
     .help = "what is passed: 0 time, 1 x, 2 y, 3 z",
     .high = 3,
     .choices = kMachineStepChoices},
    {.name = "position_mm",
     .unit = "mm",
     .help = "reading from which the jump is there (along = x, y, z)",
     .typical = 0,
     .low = -5000,
     .high = 5000,
     .only_with = {"along", "time", true},
     .sought = Sought::reading},
};

Vec3 machine_step(const TouchScene& scene, const double* theta, const double*) {
  const int along = code(theta[5]);
  const bool passed = along == 0 ? scene.time_s >= theta[1] : scene.reading[along - 1] >= theta[6];
  return passed ? theta[0] * kUm * chosen_direction(theta + 2) : Vec3{};
}

}  // namespace

constinit const Effect kMachineStep{
    .name = "machine.step",
    .title = "sudden change of the machine",
    .help =
        "From one moment on, or beyond one position of an axis, all readings jump by the same "
        "vector: a crash, a re-levelling, an air bearing that lifts. Features measured on both "
        "sides of the step no longer fit together.",
    .source = "change point; ISO 10360-2 interim checks",
    .separate =
        "return to a fixed reference sphere; approach the place from both sides; another stylus "
        "tells it from a slipped joint",
    .influence = "geometry",
    .stage = Stage::structure,
    .needs = 0u | Covariate::time,
    .parameters = kMachineStepParameters,
    .displace = machine_step,
};

}  // namespace abbe
