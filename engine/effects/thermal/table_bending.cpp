// A table that is warmer on top than below arches, and its guide of x with it.
//
//   k = a dT / h      d_z = + k s^2 / 2 + k s l_x      d_x = - k s l_z
//   s: reading of x, l: lever from the x carriage to the tip
//
// x stands for the horizontal axis whose guide lies on the table: y where the bridge or the part moves along it.
// dT = gradient_K + logged_share * (top minus bottom as logged). One coefficient makes a parabola
// in z over x and, because the carriage pitches, an Abbe error in x that grows with x and with the
// height above the x scale (bent_guide.hpp). The part is stiff or stands on three points: it does
// not bend with the table.
// Size: granite 6.5 ppm/K, 0.5 K over 0.2 m: k = 1.6e-5 per m; 0.8 m from the middle 5.2 um and 13
// urad, at 0.8 m height 10.4 um.
// Source: Timoshenko, J. Opt. Soc. Am. 11 (1925) 233, for a plate of one material; Abbe's
// principle.
// Confused with: a quadratic ezx together with a linear ebx (in the baseline: needs a known
// machine), part.load_bending.
#include "engine/effects/bent_guide.hpp"
#include "engine/effects/thermal/thermal.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kTableBendingParameters[] = {
    {.name = "gradient_K",
     .unit = "K",
     .help = "top minus bottom of the table, beyond what is logged",
     .typical = 0.5,
     .low = -20,
     .high = 20,
     .linear = true},
    {.name = "logged_share",
     .unit = "1",
     .help = "how much of the logged difference bends the table: 1 for a free plate",
     .typical = 1,
     .low = -2,
     .high = 2,
     .linear = true},
    cte_parameter(6.5, "expansion coefficient of the table"),
    {.name = "thickness_mm",
     .unit = "mm",
     .help = "between the places of the two temperatures",
     .typical = 200,
     .low = 10,
     .high = 2000,
     .standard = 200},
};

Vec3 table_bending(const TouchScene& scene, const double* theta, const double*) {
  const double difference_K = theta[0] + theta[1] * scene.temperature.table_top_minus_bottom_K;
  return bent_guide(scene, scene.on_table, thermal_curvature(theta[2], difference_K, theta[3]));
}

}  // namespace

constinit const Effect kTableBending{
    .name = "thermal.table_bending",
    .title = "table bent by a vertical gradient",
    .help =
        "The top of the table is warmer than its underside, so the table arches and the guide of "
        "x with it. Heights measured along x show a parabola, and the pitch of the carriage "
        "makes an error in x that grows with x and with the height above the scale. One "
        "curvature explains both. Where the bridge or the table moves along y, that takes the place of x.",
    .source =
        "Timoshenko, J. Opt. Soc. Am. 11 (1925) 233: curvature = cte dT / thickness; Abbe's "
        "principle",
    .separate =
        "the same artefact at two heights; logged temperatures of the table's top and underside; "
        "loading and unloading",
    .influence = "temperature gradients in the machine",
    .stage = Stage::structure,
    .needs = 0u | Covariate::position,
    .parameters = kTableBendingParameters,
    .displace = table_bending,
};

}  // namespace abbe
