// Repeatability of indexing, drawn anew at every visit to an orientation.
//
//   d = sd ( z_A dt/dA + z_B dt/dB ),   dt/dA = a x t,   dt/dB = b x t
//
// a, b: the head's axes in W; t: from the head's centre to the tip. Two numbers per visit: the
// error stays while the orientation stays, and choosing the same orientation again draws again.
// Size: 0.5 um at 62 mm (2 sigma) for a PH10M: 0.83 arcsec = 4.03 urad.
// Confused with: a larger probe noise, when each orientation is visited once per feature.
#include "engine/effects/head/head.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kHeadReindexingParameters[] = {
    {.name = "sd_urad",
     .unit = "urad",
     .help = "standard deviation per angle and indexing visit",
     .typical = 4,
     .low = 0,
     .high = 100,
     .linear = true},
};

Vec3 head_reindexing(const TouchScene& scene, const double* theta, const double* z) {
  if (!scene.stylus.indexed) return {};
  const Mat3 R_B = frame_after_b(scene.stylus);
  const Vec3 rotation = -z[0] * R_B.cy + z[1] * R_B.cz;
  return theta[0] * kUrad * cross(rotation, head_arm(scene.stylus));
}

}  // namespace

constinit const Effect kHeadReindexing{
    .name = "head.reindexing",
    .title = "repeatability of the head's indexing",
    .help =
        "Each time the head goes to an orientation it stops at slightly other angles, so the tip "
        "shifts across the stylus by angle times length. The shift is common to all touches of "
        "that visit: the scatter between visits is larger than within.",
    .source = "Van Gestel, Bleys & Kruth, section 8.2; PH10M: 0.5 um at 62 mm (2 sigma), 4.03 urad",
    .separate =
        "several visits to one orientation on a fixed sphere, with the visit recorded; a second "
        "stylus length",
    .influence = "head indexing",
    .stage = Stage::head,
    .needs = Covariate::head | Covariate::visit,
    .parameters = kHeadReindexingParameters,
    .draws_per = DrawsPer::visit,
    .draws = 2,
    .linear_in_draws = true,
    .only_spread = true,
    .displace = head_reindexing,
};

}  // namespace abbe
