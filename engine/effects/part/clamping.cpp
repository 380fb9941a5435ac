// Elastic distortion of the part by its clamps or supports.
//
//   w(u, v) = b u^2 + c v^2 + t u v + p (u^3 - 3 u v^2)        u = x_part / h,  v = y_part / h
//   displacement in the part's frame:  ( - (z - z_n) dw/dx,  - (z - z_n) dw/dy,  w ),     r = n_part . displacement
//
// The four softest modes of a plate: bow along its two directions, twist, and the sag between three
// supports. A plate that bends also turns its normals, so points off its neutral plane z_n, which bends but does not
// stretch, move sideways (Kirchhoff). The origin of the part is where its coordinates, or its touches, have it: that plane
// need not go through it. h is half the size of the part: each parameter is the deflection at that
// distance from the part's origin. Fixed to part and fixture: another clamping gives other values, so
// that it may be there in one placement only; another placement of the clamped whole gives the same.
// Size: 1 to 50 um. Source: Timoshenko & Woinowsky-Krieger, Theory of Plates and Shells, chapters 2
// and 8.
// Confused with: part.form (a distortion vanishes on unclamping), straightness errors of the
// machine when the part is not turned.
#include "engine/effects/part/part.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kClampingParameters[] = {
    {.name = "bow_um",
     .unit = "um",
     .help = "bow along the part's x: deflection along its z, half a size from its origin",
     .typical = 2,
     .low = -1000,
     .high = 1000,
     .linear = true},
    {.name = "cross_bow_um",
     .unit = "um",
     .help = "bow along the part's y",
     .typical = 2,
     .low = -1000,
     .high = 1000,
     .linear = true},
    {.name = "twist_um",
     .unit = "um",
     .help = "twist: deflection of the corner at half a size along both x and y",
     .typical = 2,
     .low = -1000,
     .high = 1000,
     .linear = true},
    {.name = "three_point_um",
     .unit = "um",
     .help = "three-lobed sag between three supports, one of them on the part's x",
     .typical = 1,
     .low = -1000,
     .high = 1000,
     .linear = true},
    {.name = "half_size_mm",
     .unit = "mm",
     .help = "half the size of the part: where the deflections are given",
     .typical = 250,
     .low = 1,
     .high = 10000,
     .standard = 250},
    kSetupParameter,
    {.name = "neutral_mm",
     .unit = "mm",
     .help = "height in the part of the plane that is bent but not stretched",
     .typical = 0,
     .low = -10000,
     .high = 10000,
     .sought = Sought::height},
};

Vec3 clamping(const TouchScene& scene, const double* theta, const double*) {
  if (!placed_in(scene, theta[5])) return {};
  const double bow = theta[0] * kUm, cross_bow = theta[1] * kUm, twist = theta[2] * kUm, lobes = theta[3] * kUm,
               h = theta[4];
  const double u = scene.on_part.x / h, v = scene.on_part.y / h;
  const double w = bow * u * u + cross_bow * v * v + twist * u * v + lobes * u * (u * u - 3 * v * v);
  const double slope_x = (2 * bow * u + twist * v + 3 * lobes * (u * u - v * v)) / h;
  const double slope_y = (2 * cross_bow * v + twist * u - 6 * lobes * u * v) / h;
  const double above_neutral = scene.on_part.z - theta[6];
  const Vec3 moved{-above_neutral * slope_x, -above_neutral * slope_y, w};
  return along_normal(scene, dot(scene.normal_on_part, moved));
}

}  // namespace

constinit const Effect kClamping{
    .name = "part.clamping",
    .title = "part distorted by clamping",
    .help =
        "The clamps or supports bend and twist the part like a plate. Surfaces are measured "
        "where they really are, but not where they will be when the part is free. The pattern is "
        "fixed to the part with its fixture, goes with them to another place, and changes when "
        "the part is clamped again: then it may be there in one placement only.",
    .source = "Timoshenko & Woinowsky-Krieger, Theory of Plates and Shells: lowest bending modes",
    .separate =
        "unclamp and clamp again; turn the clamped part to another place; release the clamps and "
        "measure",
    .influence = "fixturing",
    .stage = Stage::part,
    .needs = Covariate::normal | Covariate::part_frame,
    .parameters = kClampingParameters,
    .displace = clamping,
};

}  // namespace abbe
