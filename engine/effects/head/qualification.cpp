// Ageing of the qualification with temperature.
//
//   d = (T - T_q) [ growth s + tilt_A dt/dA + tilt_B dt/dB ]
//
// Tip offsets are right at the temperature T_q of the qualification. As head and stylus warm, the
// tip moves away from the head (growth: steel 100 mm 1.2 um/K, carbide 0.5, carbon fibre about 0)
// and the angles of the head's body drift; both turn with the orientation, so each orientation
// drifts along its own vector. T: temperature of the air, for want of one of the head.
// Confused with: thermal.stylus_growth (its growth along s), head.axis_errors when the temperature
// hardly changed.
#include "engine/effects/head/head.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kHeadQualificationParameters[] = {
    {.name = "growth_um_per_K",
     .unit = "um/K",
     .help = "lengthening from the head's centre to the tip per kelvin",
     .typical = 1,
     .low = -20,
     .high = 20,
     .linear = true},
    {.name = "tilt_a_urad_per_K",
     .unit = "urad/K",
     .help = "drift of the angle A per kelvin",
     .typical = 3,
     .low = -100,
     .high = 100,
     .linear = true},
    {.name = "tilt_b_urad_per_K",
     .unit = "urad/K",
     .help = "drift of the angle B per kelvin",
     .typical = 3,
     .low = -100,
     .high = 100,
     .linear = true},
    {.name = "qualified_at_C",
     .unit = "C",
     .help = "temperature at the qualification",
     .typical = 20,
     .low = 0,
     .high = 50,
     .standard = 20},
};

Vec3 head_qualification(const TouchScene& scene, const double* theta, const double*) {
  const Mat3 R_B = frame_after_b(scene.stylus);
  const Vec3 rotation = -theta[1] * R_B.cy + theta[2] * R_B.cz;
  const Vec3 per_kelvin = theta[0] * kUm * scene.stylus.to_head + kUrad * cross(rotation, head_arm(scene.stylus));
  return (scene.temperature.air - theta[3]) * per_kelvin;
}

}  // namespace

constinit const Effect kHeadQualification{
    .name = "head.qualification",
    .title = "qualification that aged with temperature",
    .help =
        "The tip offsets were right when the styli were qualified; since then head and stylus "
        "changed temperature, and every orientation drifts along its own vector. A new "
        "qualification removes it.",
    .source = "thermal expansion of head and stylus; ISO 10360-5 location test",
    .separate = "qualify again and compare; the fixed sphere in all orientations at two temperatures",
    .influence = "head geometry and qualification",
    .stage = Stage::head,
    .needs = Covariate::head | Covariate::air_temperature | Covariate::qualification,
    .parameters = kHeadQualificationParameters,
    .displace = head_qualification,
};

}  // namespace abbe
