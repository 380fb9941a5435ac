// A scale that reads long or short, on one axis or all alike.
//
//   d_i = k x_i,    x_i: reading of axis i,   k > 0: the scale reads long
//
// Size: 1 to 20 um/m after transport, a crash, or a temperature that was not compensated. In ISO
// 230-1 terms the linear part of exx, eyy or ezz.
// Confused with: the linear terms of the machine's own error functions (nameable only on a known
// machine), thermal.scale_expansion, and - all axes together - the expansion of the part.
#include "engine/effects/machine/machine.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

constexpr std::string_view kMachineScaleChoices[] = {"x", "y", "z", "all"};
constexpr int kAll = 3;

constexpr EffectParameter kMachineScaleParameters[] = {
    {.name = "scale_um_per_m",
     .unit = "um/m",
     .help = "relative error of the scale; reads long when positive",
     .typical = 5,
     .low = -1000,
     .high = 1000,
     .linear = true},
    {.name = "axis",
     .unit = "code",
     .help = "which scale: 0 x, 1 y, 2 z, 3 all three alike",
     .high = kAll,
     .choices = kMachineScaleChoices},
};

Vec3 machine_scale(const TouchScene& scene, const double* theta, const double*) {
  const int axis = code(theta[1]);
  const double k = theta[0] * 1e-6;
  return axis == kAll ? k * scene.reading : k * scene.reading[axis] * axis_vector(axis);
}

}  // namespace

constinit const Effect kMachineScale{
    .name = "machine.scale",
    .title = "scale reads long or short",
    .help =
        "All lengths along one axis are too long or too short by the same share. On all three axes "
        "alike it is a uniform scale, which a part at another temperature looks like.",
    .source =
        "ISO 230-1; ISO 10360-2; artefact-based checks report three relative scales and three "
        "squarenesses",
    .separate =
        "the same artefact along each axis and over the whole volume; two temperatures tell it "
        "from the part's expansion",
    .influence = "geometry",
    .stage = Stage::scale,
    .needs = 0u | Covariate::position,
    .parameters = kMachineScaleParameters,
    .displace = machine_scale,
};

}  // namespace abbe
