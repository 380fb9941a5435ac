// Flattening of tip and surface at the contact: Hertz.
//
//   delta = ( 9 F^2 / (16 Rr E*^2) )^(1/3),   1/E* = sum (1 - nu^2)/E,
//   1/Rr = 1/R_tip + 1/R_surface
//   r = - factor [ delta(part) - delta(reference sphere) ]
//
// The part is taken as plane (R_surface infinite: its curvature is small against the tip's), the
// tip as ruby (400 GPa, nu 0.29). Only the difference to the qualification sphere remains, below
// 0.1 um for touch-trigger forces.
// Sizes of delta for a ruby tip of R = 1 mm on steel / aluminium: 0.063 / 0.108 um at 0.1 N, 0.29 /
// 0.50 um at 1 N; R = 0.25 mm, 0.1 N, steel 0.10 um.
// Source: Hertz 1882; Puttock & Thwaite, CSIRO 1969, as used by NIST.
// Confused with: probe.tip_radius.
#include "engine/effects/probe/probe.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kContactFlatteningParameters[] = {
    {.name = "factor",
     .unit = "1",
     .help = "1: as Hertz's theory says; 0: none",
     .typical = 1,
     .low = -10,
     .high = 100,  // a plastic part under a newton flattens sixty times as much as aluminium under 0.1 N
     .standard = 1,
     .linear = true},
    {.name = "force_N",
     .unit = "N",
     .help = "force at the trigger",
     .typical = 0.1,
     .low = 0,
     .high = 5,
     .standard = 0.1},
    {.name = "part_young_GPa",
     .unit = "GPa",
     .help = "Young's modulus of the part: aluminium 70, steel 210",
     .typical = 70,
     .low = 0.5,
     .high = 1000,
     .standard = 70},
    {.name = "part_poisson",
     .unit = "1",
     .help = "Poisson's ratio of the part",
     .typical = 0.33,
     .low = 0,
     .high = 0.5,
     .standard = 0.33},
    {.name = "sphere_radius_mm",
     .unit = "mm",
     .help = "radius of the reference sphere; 0: not subtracted",
     .typical = 12.5,
     .low = 0,
     .high = 100,
     .standard = 12.5},
    {.name = "sphere_young_GPa",
     .unit = "GPa",
     .help = "Young's modulus of the reference sphere: steel 210, alumina 380",
     .typical = 380,
     .low = 1,
     .high = 1000,
     .standard = 380},
    {.name = "sphere_poisson",
     .unit = "1",
     .help = "Poisson's ratio of the reference sphere",
     .typical = 0.23,
     .low = 0,
     .high = 0.5,
     .standard = 0.23},
};

constexpr double kRubyGPa = 400, kRubyPoisson = 0.29;

/// Approach of two bodies under a force, mm; `curvature_per_mm` = 1/Rr.
double approach_mm(double force_N, double curvature_per_mm, double young_GPa, double poisson) {
  const double softness =
      1e-3 * ((1 - poisson * poisson) / young_GPa + (1 - kRubyPoisson * kRubyPoisson) / kRubyGPa);  // mm^2/N
  const double f = force_N * softness;
  return std::cbrt(9.0 / 16 * f * f * curvature_per_mm);
}

Vec3 contact_flattening(const TouchScene& scene, const double* theta, const double*) {
  const double tip = scene.stylus.radius_mm;
  if (tip <= 0) return {};  // a point has no Hertzian contact
  double flattening = approach_mm(theta[1], 1 / tip, theta[2], theta[3]);
  if (theta[4] > 0) flattening -= approach_mm(theta[1], 1 / tip + 1 / theta[4], theta[5], theta[6]);
  return along_normal(scene, -theta[0] * flattening);
}

}  // namespace

constinit const Effect kContactFlattening{
    .name = "probe.contact_flattening",
    .title = "elastic flattening at the contact",
    .help =
        "Tip and surface flatten under the measuring force, so the surface seems too far in. The "
        "qualification removes the flattening on the reference sphere; a part of softer material "
        "keeps the difference. Small for touch-trigger probes, felt with small tips, large forces "
        "and soft parts.",
    .source = "Hertz (1882); Puttock & Thwaite, CSIRO Tech. Paper 25 (1969)",
    .separate =
        "the same feature in another material; another force (it grows with F^(2/3)); two tip "
        "radii",
    .influence = "contact deformation",
    .stage = Stage::probe,
    .needs = Covariate::normal | Covariate::sensor,
    .parameters = kContactFlatteningParameters,
    .displace = contact_flattening,
};

}  // namespace abbe
