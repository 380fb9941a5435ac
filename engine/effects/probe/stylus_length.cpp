// A stylus length entered wrongly, or a wrong tip assigned.
//
//   d = dL s,    s: from the tip towards the head
//
// dL: true minus assumed length. The true tip lies dL further from the head than the machine
// believes, so the reported tip lies dL s from the true one. It concerns orientations whose tip
// offset is computed from one length; an orientation that is qualified itself keeps only the wrong
// Abbe arm (0.1 um for 10 mm at 10 urad), which is left out.
// Size: 0.01 to 10 mm when it happens.
// Confused with: head.axis_errors (rho 0.8 to 0.9), and a shift of the part when all is measured
// with one orientation.
#include "engine/effects/probe/probe.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kStylusLengthParameters[] = {
    {.name = "length_error_um",
     .unit = "um",
     .help = "true minus assumed length along the stylus; positive: longer than assumed",
     .typical = 2,
     .low = -20000,
     .high = 20000,
     .linear = true},
    kSensorParameter,
};

Vec3 stylus_length(const TouchScene& scene, const double* theta, const double*) {
  return concerns(scene.stylus, theta[1]) ? theta[0] * kUm * scene.stylus.to_head : Vec3{};
}

}  // namespace

constinit const Effect kStylusLength{
    .name = "probe.stylus_length",
    .title = "stylus longer or shorter than assumed",
    .help =
        "The length used to compute the tip offset is wrong: mis-entered, or another tip than "
        "assigned. Every orientation of the head shifts by a constant vector along its stylus; "
        "with a single orientation the whole part merely seems to be shifted.",
    .source = "geometry of the head (Van Gestel, Bleys & Kruth, eq. 25)",
    .separate = "three or more orientations of the head, one at 45 degrees, on a fixed sphere",
    .influence = "stylus bending and length",
    .stage = Stage::probe,
    .needs = 0u | Covariate::head,
    .parameters = kStylusLengthParameters,
    .displace = stylus_length,
};

}  // namespace abbe
