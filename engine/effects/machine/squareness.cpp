// Change of the angle between two axes.
//
//   cwy: d_x = g y      bwz: d_x = g z      awz: d_y = g z
//
// g > 0: the angle is larger than 90 degrees by g. Then a move along +y really leads towards -x,
// where the x scale does not see it: the machine reads too far in +x.
// Size: 1 to 20 um/m after transport, a crash or a temperature gradient.
// Confused with: the linear terms of the straightness functions; the form of the tip when only one
// sphere was measured; machine.ram_droop with awz.
#include "engine/effects/machine/machine.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

constexpr std::string_view kMachineSquarenessChoices[] = {"cwy", "bwz", "awz"};

constexpr EffectParameter kMachineSquarenessParameters[] = {
    {.name = "squareness_urad",
     .unit = "urad",
     .help = "change of the angle between the axes; positive: larger than 90 degrees",
     .typical = 5,
     .low = -1000,
     .high = 1000,
     .linear = true},
    {.name = "which",
     .unit = "code",
     .help = "0 cwy: x-y, 1 bwz: x-z, 2 awz: y-z",
     .high = 2,
     .choices = kMachineSquarenessChoices},
};

Vec3 machine_squareness(const TouchScene& scene, const double* theta, const double*) {
  const double angle = theta[0] * kUrad;
  switch (code(theta[1])) {
    case 0: return {angle * scene.reading.y, 0, 0};
    case 1: return {angle * scene.reading.z, 0, 0};
    default: return {0, angle * scene.reading.z, 0};
  }
}

}  // namespace

constinit const Effect kMachineSquareness{
    .name = "machine.squareness",
    .title = "two axes not square",
    .help =
        "The angle between two axes is not 90 degrees. One diagonal of their plane is measured too "
        "long and the other too short; lengths along the axes stay right.",
    .source = "ISO 230-1; ISO 10360-2",
    .separate =
        "a ball bar or gauge in both diagonals, or a reversal square; on a single small sphere it "
        "looks like the tip's form",
    .influence = "geometry",
    .stage = Stage::structure,
    .needs = 0u | Covariate::position,
    .parameters = kMachineSquarenessParameters,
    .displace = machine_squareness,
};

}  // namespace abbe
