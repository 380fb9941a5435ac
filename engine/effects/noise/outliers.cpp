// Single touches that are grossly wrong.
//
//   r = +-size exp(0.7 z2)   with probability `share`,   else 0
//
// Dirt and burrs make a surface proud, and a probe that triggers early reads the same way: outliers
// are one-sided, r > 0, but for those of a probe that is disturbed, of which a share `opposite` has
// the other sign. Their sizes are log-normal about the median `size`: 95 % between a quarter
// and four times of it, 3 to 50 um for the standard 12 um. z1 decides whether and to which side, z2 how much. Size:
// 0.1 to 2 % of the touches.
// Source: contamination model of robust statistics (Huber 1964), one-sided.
// Confused with: nothing else makes a few large residuals of one sign; but in small numbers they
// pass for a form error. Software that removes touches beyond k sigma around the fit biases the
// spread.
#include "engine/effects/noise/noise.hpp"
#include "engine/math/normal.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kOutliersParameters[] = {
    {.name = "share",
     .unit = "1",
     .help = "share of the touches that are outliers",
     .typical = 0.005,
     .low = 0,
     .high = 0.5},
    {.name = "size_um",
     .unit = "um",
     .help = "median size of an outlier; positive: the surface seems too far out",
     .typical = 12,
     .low = -1000,
     .high = 1000,
     .standard = 12,
     .linear = true},
    {.name = "opposite", .unit = "1", .help = "share of the outliers that lie on the other side", .low = 0, .high = 1},
};

Vec3 outliers(const TouchScene& scene, const double* theta, const double* z) {
  const double chance = normal_below(z[0]);
  if (chance >= theta[0]) return {};
  const double side = chance < theta[0] * theta[2] ? -1 : 1;
  return along_normal(scene, side * theta[1] * kUm * std::exp(kOutlierLogSpread * z[1]));
}

}  // namespace

constinit const Effect kOutliers{
    .name = "noise.outliers",
    .title = "outliers",
    .help =
        "A few touches are wrong by many times the usual scatter: dirt, a burr, a probe that "
        "triggers early. The surface then seems too far out; where a probe is disturbed, or triggers "
        "late, some seem too far in. One of them can "
        "decide a form error, a maximum or a small alignment feature.",
    .source = "Huber, Ann. Math. Statist. 35 (1964): contaminated normal; one-sided",
    .separate = "clean the part and repeat the suspect touches",
    .influence = "vibration and outliers",
    .stage = Stage::noise,
    .needs = 0u | Covariate::normal,
    .parameters = kOutliersParameters,
    .draws_per = DrawsPer::touch,
    .draws = 2,
    .displace = outliers,
};

}  // namespace abbe
