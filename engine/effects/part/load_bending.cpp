// The table sags under the weight of the part, and the guides with it.
//
//   k = 8 (sag per 500 kg) (m / 500 kg) / Lx^2,   Lx: travel of x
//   d_z = - k [ s_x^2/2 + s_x l_x + q (s_y^2/2 + s_y l_y) ]
//   d_x = + k s_x l_z      d_y = + q k s_y l_z
//
// x stands for the axis whose guide lies on the table: y where the bridge or the part moves along it.
//
// To first order a central load makes a bowl: equal curvatures along x and y (q = 1). Rails of x at
// the sides of the table follow its curvature along x only (q = 0). The guides pitch with their
// slope, so the sag comes with its Abbe part (bent_guide.hpp; here the middle is low, which is a
// negative arch). The part is stiff, or stands on three points: it does not bend with the table. m
// is the logged load plus `mass_kg`; it may be there in one placement only (`setup`), which a diagnosis
// seeks where loads were not logged. Size: 0.5 to 5 um per 500 kg.
// Source: elastic plate, deflection proportional to the load; ISO 10360-2 tests under load where
// the maker rates one.
// Confused with: thermal.table_bending (a bowl against an arch along x only), quadratic ezx and ezy
// (needs a known machine).
#include "engine/effects/bent_guide.hpp"
#include "engine/effects/part/part.hpp"

namespace abbe {
namespace {

constexpr double kRatedLoad_kg = 500;

constexpr double kRailsOrBowl[] = {0, 1};

constexpr EffectParameter kLoadBendingParameters[] = {
    {.name = "sag_um_per_500kg",
     .unit = "um",
     .help =
         "sag of the middle of the x travel (y, where the bridge or the table moves along it) below its ends, under 500 kg",
     .typical = 1.5,
     .low = 0,
     .high = 100,
     .linear = true},
    {.name = "mass_kg",
     .unit = "kg",
     .help = "mass on the table besides the logged load",
     .typical = 0,
     .low = 0,
     .high = 20000},
    {.name = "cross_share",
     .unit = "1",
     .help = "curvature along y over curvature along x: 1 for a bowl, 0 for rails at the sides",
     .typical = 1,
     .low = 0,
     .high = 2,
     .standard = 1,
     .sought = Sought::listed,
     .tried = kRailsOrBowl},
    {.name = "setup",
     .unit = "code",
     .help = "in which placement of the part the load is on the table; 0: in every one",
     .high = 1e6,
     .sought = Sought::setup,
     .unless_logged = 0u | Covariate::load},
};

Vec3 load_bending(const TouchScene& scene, const double* theta, const double*) {
  if (!placed_in(scene, theta[3])) return {};
  const double load = (scene.load_kg + theta[1]) / kRatedLoad_kg, travel = scene.travel_length_mm[scene.on_table];
  const double curvature = 8 * theta[0] * kUm * load / (travel * travel);
  return bent_guide(scene, scene.on_table, -curvature) + bent_guide(scene, 1 - scene.on_table, -theta[2] * curvature);
}

}  // namespace

constinit const Effect kLoadBending{
    .name = "part.load_bending",
    .title = "table bent by the part's weight",
    .help =
        "The table sags under the part like a bowl, and the guides that it carries follow. A "
        "light artefact measured on the same place shows nothing; under load, heights show a "
        "parabola over the table, and the pitch of the carriages makes errors in x and y that "
        "grow with the height. In proportion to the mass.",
    .source = "elastic plate under a central load; ISO 10360-2 under the rated load",
    .separate = "the same artefact with and without dead weight on the table",
    .influence = "fixturing",
    .stage = Stage::structure,
    .needs = Covariate::position | Covariate::load,
    .parameters = kLoadBendingParameters,
    .displace = load_bending,
};

}  // namespace abbe
