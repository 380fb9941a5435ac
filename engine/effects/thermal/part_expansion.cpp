// Expansion of the part that the compensation does not know.
//
//   e = [ (a - a_set) (T - 20) + a (T - T_set) ] (c - c0) + s (T - 20),    r = n . e
//
// The compensation reckons with the expansion coefficient a_set and the temperature T_set; the part
// has a and T. The first term vanishes at 20 degrees C and is proportional to T - 20; the second is
// a constant scale. c0 is the origin of the part's frame; it stands still where the part is held there, and moves by s
// for each kelvin where it is held elsewhere. Without any compensation the whole
// coefficient is the error. A part may be warm in one placement only (`setup`), as one that comes from another room; a
// diagnosis seeks that where the temperature of the part was not logged. Standard uncertainty of a length, with DT = T - 20:
//   u(L)/L = sqrt( (DT u_a)^2 + (a u_T)^2 )
// Sizes: 500 mm steel at 1 K uncompensated 5.75 um; 10 % of 11.5 ppm/K at 5 K 5.8 um/m; a sensor
// that is off by 0.3 K 3.5 um/m.
// Sources: ISO 1, ISO/TR 16015; Swyt, J. Res. NIST 99 (1994): Al 23.1, steel 11.5, Si 2.6 ppm/K.
// Confused with: the second term with an error of the artefact's length and with machine.scale of
// all axes together (rho 1.00 at one temperature, 0.03 with two); both terms with thermal.part_soak
// in a short program.
#include "engine/effects/thermal/thermal.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kPartExpansionParameters[] = {
    {.name = "cte_error_ppm_per_K",
     .unit = "ppm/K",
     .help = "true minus assumed expansion coefficient of the part",
     .typical = 1,
     .low = -30,
     .high = 30,
     .linear = true},
    {.name = "temperature_error_K",
     .unit = "K",
     .help = "true minus assumed temperature of the part: error of its sensor",
     .typical = 0.1,
     .low = -20,
     .high = 20,
     .linear = true},
    cte_parameter(11.5, "expansion coefficient of the part, on which an error of temperature acts"),
    kHeldParameter,
    shift_parameter(
        "shift_x_um_per_K", "um/K",
        "shift of the origin along the part's x for each kelvin above 20 degrees C, if it is held elsewhere"),
    shift_parameter("shift_y_um_per_K", "um/K", "the same along y"),
    shift_parameter("shift_z_um_per_K", "um/K", "the same along z"),
    {.name = "setup",
     .unit = "code",
     .help = "in which placement the part was so warm; 0: in every one",
     .high = 1e6,
     .sought = Sought::setup,
     .unless_logged = 0u | Covariate::part_temperature},
};

Vec3 part_expansion(const TouchScene& scene, const double* theta, const double*) {
  if (!placed_in(scene, theta[7])) return {};
  const double above_K = scene.temperature.part - kReferenceTemperature_C;
  return isotropic_growth(scene, kPpm * (theta[0] * above_K + theta[2] * theta[1])) +
      origin_shift(scene, theta[3], above_K * Vec3{theta[4], theta[5], theta[6]});
}

}  // namespace

constinit const Effect kPartExpansion{
    .name = "thermal.part_expansion",
    .title = "expansion of the part not compensated",
    .help =
        "The part is warmer or colder than 20 degrees C, and its expansion is compensated with a "
        "wrong coefficient or a wrong temperature. All its lengths are wrong in proportion: "
        "residuals grow from the part's origin in every direction and follow the part when it is "
        "moved. Held elsewhere, the part also shifts as its temperature changes. The error of the coefficient vanishes at 20 degrees C, that of the temperature "
        "does not.",
    .source = "ISO 1; ISO/TR 16015; Swyt, J. Res. NIST 99 (1994): steel 11.5, aluminium 23.1 ppm/K",
    .separate =
        "two temperatures: the slope of the scale factor is the coefficient, what remains at 20 "
        "degrees C the sensor or the artefact; a turned part; a second artefact of another "
        "material",
    .influence = "part temperature",
    .stage = Stage::thermal,
    .needs = Covariate::normal | Covariate::part_frame | Covariate::part_temperature,
    .parameters = kPartExpansionParameters,
    .displace = part_expansion,
};

}  // namespace abbe
