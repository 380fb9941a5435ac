// Expansion of the scales that the compensation does not know.
//
//   d_i = - [ (a - a_set) (T_i - 20) + a (T_i - T_i,set) ] s_i      i = x, y, z
//
// A warmer scale has longer divisions: the axis counts too few of them and reads short. s_i is the
// reading, counted from the scale's fixed point at its zero. One coefficient for the three scales,
// one error of temperature for each.
// Size: 1 to 10 um/m per axis. Glass 8, steel tape 10 to 11 ppm/K.
// Sources: ISO 1, ISO/TR 16015; data sheets of linear encoders.
// Confused with: machine.scale (the constant part is the same thing), the linear part of exx, eyy
// and ezz: only a change between two temperatures, or against a calibrated machine, can be named;
// thermal.part_expansion when all scales and the part change together.
#include "engine/effects/thermal/thermal.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kScaleExpansionParameters[] = {
    {.name = "cte_error_ppm_per_K",
     .unit = "ppm/K",
     .help = "true minus assumed expansion coefficient of the scales",
     .typical = 1,
     .low = -15,  // a scale that does not expand, taken for one of steel
     .high = 25,  // one of aluminium that is not compensated
     .linear = true},
    {.name = "x_temperature_error_K",
     .unit = "K",
     .help = "true minus assumed temperature of the x scale",
     .typical = 0.1,
     .low = -20,
     .high = 20,
     .linear = true},
    {.name = "y_temperature_error_K",
     .unit = "K",
     .help = "true minus assumed temperature of the y scale",
     .typical = 0.1,
     .low = -20,
     .high = 20,
     .linear = true},
    {.name = "z_temperature_error_K",
     .unit = "K",
     .help = "true minus assumed temperature of the z scale",
     .typical = 0.1,
     .low = -20,
     .high = 20,
     .linear = true},
    cte_parameter(10.5, "expansion coefficient of the scales, on which an error of temperature acts"),
};

Vec3 scale_expansion(const TouchScene& scene, const double* theta, const double*) {
  Vec3 d;
  for (int axis = 0; axis < 3; ++axis) {
    const double above_K = scene.temperature.scale[axis] - kReferenceTemperature_C;
    d[axis] = -kPpm * (theta[0] * above_K + theta[4] * theta[1 + axis]) * scene.reading[axis];
  }
  return d;
}

}  // namespace

constinit const Effect kScaleExpansion{
    .name = "thermal.scale_expansion",
    .title = "expansion of the scales not compensated",
    .help =
        "The scales are not at 20 degrees C, and their expansion is compensated with a wrong "
        "coefficient or a wrong temperature. A scale that is warmer than assumed reads short, in "
        "proportion to the reading. Axes with different temperatures give different scale "
        "factors, and a turned part keeps none of it.",
    .source = "ISO 1; ISO/TR 16015; data sheets of linear encoders: glass 8, steel tape 10.5 ppm/K",
    .separate =
        "the same artefact along each axis at two temperatures; an artefact of nearly no "
        "expansion",
    .influence = "scale temperature",
    .stage = Stage::thermal,
    .needs = Covariate::position | Covariate::scale_temperature,
    .parameters = kScaleExpansionParameters,
    .displace = scale_expansion,
};

}  // namespace abbe
