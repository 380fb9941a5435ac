// Bending of the stylus under the trigger force.
//
//   r = - L^3 / (3 E I) [ F (cos^2 beta - 2/3) + dF cos^2 beta ],   I = pi d^4 / 64
//
// sin beta = |n . s|. A slender beam clamped at the head and loaded at the tip by the component F
// cos(beta) across the shaft deflects F cos(beta) L^3/3EI; of that, cos(beta) shows along the
// normal. The machine moves on by this much before the probe triggers, so the surface seems too far
// in. A qualification at the same force stores the mean over its directions (hemisphere: the mean
// of cos^2 beta is 2/3) as a smaller tip; what stays is the difference between equator and pole,
// and in full whatever the force changed since (dF).
// Sizes at 0.1 N: carbide 30 x 1.5 mm 5.8 um, steel 50 x 2 26.5, carbide 50 x 2 8.6, carbon fibre
// 100 x 3 18.6.
// Confused with: the elevation term of probe.pretravel_lobing (rho 0.97 in every usual design), the
// oval term of probe.tip_form.
#include "engine/effects/probe/probe.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kStylusBendingParameters[] = {
    {.name = "force_N",
     .unit = "N",
     .help = "trigger force, the same at the qualification and in use",
     .typical = 0.1,
     .low = 0,
     .high = 2,
     .linear = true},
    {.name = "force_change_N",
     .unit = "N",
     .help = "trigger force in use minus trigger force at the qualification",
     .typical = 0.02,
     .low = -2,
     .high = 2,
     .linear = true},
};

/// Deflection of the tip per force across the shaft, mm/N. A stylus without data of its shaft
/// counts as rigid.
double compliance(const StylusScene& stylus) {
  const double d2 = stylus.shaft_diameter_mm * stylus.shaft_diameter_mm;
  const double stiffness = 3 * stylus.young_MPa * kPi * d2 * d2 / 64;
  const double length = stylus.length_mm;
  return stiffness > 0 ? length * length * length / stiffness : 0;
}

Vec3 stylus_bending(const TouchScene& scene, const double* theta, const double*) {
  constexpr double kMeanOverHemisphere = 2.0 / 3;
  const double along = dot(scene.normal, scene.stylus.to_head);
  const double across2 = 1 - along * along;
  const double bending_force = theta[0] * (across2 - kMeanOverHemisphere) + theta[1] * across2;
  return along_normal(scene, -compliance(scene.stylus) * bending_force);
}

}  // namespace

constinit const Effect kStylusBending{
    .name = "probe.stylus_bending",
    .title = "stylus bends under the trigger force",
    .help =
        "The shaft bends before the probe triggers, most when it is touched sideways and not at "
        "all along the shaft. The qualification removes the mean; touches across the shaft then "
        "read too far in and touches along it too far out. It grows with the third power of the "
        "length and falls with the fourth of the diameter. A change of the trigger force since the "
        "qualification shows in full.",
    .source = "Euler-Bernoulli cantilever; Estler et al., Precision Engineering 19 (1996)",
    .separate =
        "another trigger force (module or level); two styli of the same length with different "
        "shafts",
    .influence = "stylus bending and length",
    .stage = Stage::probe,
    .needs = Covariate::normal | Covariate::sensor,
    .parameters = kStylusBendingParameters,
    .displace = stylus_bending,
};

}  // namespace abbe
