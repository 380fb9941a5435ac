// A bridge with a vertical gradient in its beam, or with legs of unequal temperature.
//
//   beam:  k = a dT / h      d_z = + k s^2 / 2 + k s l_y     d_y = - k s l_z
//          s: reading of y, l: lever from the saddle to the tip
//          y: the horizontal axis along the bridge; x where the bridge or the part moves along y
//   legs:  f = a H dT_legs / W  (rad)     d = - (f e_x) x (lever from the foot of the guided leg)
//
// dT (top minus bottom of the beam) and dT_legs (leg at large y minus leg at small y) are
// parameters plus a share of what is logged. A longer leg at large y rolls the whole bridge about
// +X by f. Beam and ram roll together, so a constant f is a rigid turn that any alignment takes
// out; it shows when the legs change temperature between two measurements, as a turn about X that
// follows the time. The beam's bow stays visible. The foot stands below the saddle's frame by the
// height of the legs.
// Size: aluminium beam of 0.2 m, 0.2 K, 1 m long: 2.9 um bow; legs of 1 m, 0.2 K, 1.2 m apart: 3.8
// urad.
// Source: Timoshenko, J. Opt. Soc. Am. 11 (1925) 233, for a beam of one material.
// Confused with: a quadratic ezy with a linear eay (needs a known machine), a change of
// machine.squareness, thermal.drift.
#include "engine/effects/bent_guide.hpp"
#include "engine/effects/thermal/thermal.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kBridgeBendingParameters[] = {
    {.name = "gradient_K",
     .unit = "K",
     .help = "top minus bottom of the beam, beyond what is logged",
     .typical = 0.2,
     .low = -20,
     .high = 20,
     .linear = true},
    {.name = "legs_K",
     .unit = "K",
     .help = "leg at large y minus leg at small y, beyond what is logged",
     .typical = 0.2,
     .low = -20,
     .high = 20,
     .linear = true},
    {.name = "logged_share",
     .unit = "1",
     .help = "how much of the logged differences acts: 1 for a free bridge",
     .typical = 1,
     .low = -2,
     .high = 2,
     .linear = true},
    cte_parameter(23.1, "expansion coefficient of the bridge"),
    {.name = "beam_height_mm",
     .unit = "mm",
     .help = "between top and bottom of the beam",
     .typical = 200,
     .low = 10,
     .high = 2000,
     .standard = 200},
    {.name = "leg_length_mm",
     .unit = "mm",
     .help = "height of the legs",
     .typical = 1000,
     .low = 10,
     .high = 10000,
     .standard = 1000},
    {.name = "leg_distance_mm",
     .unit = "mm",
     .help = "between the legs, along the bridge",
     .typical = 1200,
     .low = 100,
     .high = 10000,
     .standard = 1200},
};

/// A bridge along y that is turned about +X by `roll_rad` (along x: about -Y), on a foot `leg_length_mm`
/// below the saddle's frame at home.
Vec3 rolled(const TouchScene& scene, double roll_rad, double leg_length_mm) {
  const int along = scene.on_bridge;
  const Vec3& from_saddle = scene.lever_mm[along];
  const double across = scene.reading[along] + from_saddle[along];
  Vec3 d{0, 0, -roll_rad * across};
  d[along] = roll_rad * (from_saddle.z + leg_length_mm);
  return d;
}

Vec3 bridge_bending(const TouchScene& scene, const double* theta, const double*) {
  const double beam_K = theta[0] + theta[2] * scene.temperature.bridge_gradient_K;
  const double legs_K = theta[1] + theta[2] * scene.temperature.legs_difference_K;
  const double roll_rad = theta[3] * kPpm * theta[5] * legs_K / theta[6];
  return bent_guide(scene, scene.on_bridge, thermal_curvature(theta[3], beam_K, theta[4])) +
      rolled(scene, roll_rad, theta[5]);
}

}  // namespace

constinit const Effect kBridgeBending{
    .name = "thermal.bridge_bending",
    .title = "bridge bent or rolled by gradients",
    .help =
        "The top of the beam is warmer than its bottom, so the beam arches and heights measured "
        "along y show a parabola, with a roll of the saddle that makes an error in y below the "
        "beam. One leg warmer than the other rolls the bridge about x; beam and ram turn "
        "together, so this shows only when it changes between two measurements. Where the bridge or "
        "the table moves along y, x and y change places.",
    .source =
        "Timoshenko, J. Opt. Soc. Am. 11 (1925) 233: curvature = cte dT / height; roll = cte H "
        "dT / W",
    .separate = "repeat at another time of day with sensors on beam and legs; a reversal square",
    .influence = "temperature gradients in the machine",
    .stage = Stage::structure,
    .needs = 0u | Covariate::position,
    .parameters = kBridgeBendingParameters,
    .displace = bridge_bending,
};

}  // namespace abbe
