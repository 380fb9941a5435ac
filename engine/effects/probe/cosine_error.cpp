// Tip compensation along the approach instead of the surface normal.
//
//   r = share * R (1 - cos gamma),    cos gamma = - a . n
//
// The ball touches at P and its centre is at P + R n. A machine that corrects by R along its
// approach a, not knowing the normal, reports P + R n + R a: along n that is R (1 - cos gamma) too
// far out. Always one sign, quadratic in the angle.
// Size: 5 degrees, R = 1 mm: 3.8 um. The skid of the tip by friction acts across n and so does not
// reach a reading to first order: it is left out.
// Source: geometry of the contact.
// Confused with: probe.tip_radius when the angle never changes.
#include <algorithm>

#include "engine/effects/probe/probe.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kCosineErrorParameters[] = {
    {.name = "share",
     .unit = "1",
     .help = "1: the tip is compensated along the approach; 0: along the true normal",
     .typical = 1,
     .low = -2,
     .high = 2,
     .standard = 1,
     .linear = true},
};

Vec3 cosine_error(const TouchScene& scene, const double* theta, const double*) {
  const double cosine = -dot(approach(scene), scene.normal);
  return along_normal(scene, theta[0] * scene.stylus.radius_mm * std::max(0.0, 1 - cosine));
}

}  // namespace

constinit const Effect kCosineError{
    .name = "probe.cosine_error",
    .title = "tip compensated along the wrong direction",
    .help =
        "A point is probed askew, and the tip radius is compensated along the approach or the "
        "nominal normal. The surface then seems too far out by R (1 - cos angle): never too far "
        "in, four times larger at twice the angle, proportional to the tip radius.",
    .source = "geometry of the contact; ISO 10360-5 and probing guides ask for approach along the normal",
    .separate = "probe the same point under several angles; several tip radii",
    .influence = "number and place of the points",
    .stage = Stage::probe,
    .needs = Covariate::normal | Covariate::direction | Covariate::sensor,
    .parameters = kCosineErrorParameters,
    .displace = cosine_error,
};

}  // namespace abbe
