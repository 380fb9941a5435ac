// One group of touches scatters more than the others.
//
//   r = sd sqrt(ratio^2 - 1) z   in the group,   0 outside     z: standard normal per touch
//
// sd is the scatter that all touches have already (the probe's); the group gets what is missing to
// ratio * sd. Groups: styli longer than a limit, a tilted head, probing faster than a limit, one orientation
// of the head, one feature, one setup, one run, a stretch of time. Size: twice the scatter with a stylus twice
// as long.
// Source: variances add (JCGM 100, 5.1.2); dependence on stylus length, head angle and speed after
// ISO 10360-5 and data sheets of probes.
// Confused with: noise.vibration when the group is one direction; noise.outliers when the group is
// small.
#include "engine/effects/noise/noise.hpp"

namespace abbe {
namespace {

enum Group { long_styli, tilted_head, fast_probing, one_orientation, one_feature, one_setup, one_run, stretch_of_time };
constexpr std::string_view kGroups[] = {"long styli",  "tilted head", "fast probing", "one orientation",
                                        "one feature", "one setup",   "one run",      "a stretch of time"};

constexpr EffectParameter kUnequalNoiseParameters[] = {
    {.name = "ratio",
     .unit = "1",
     .help = "standard deviation in the group over that of the other touches",
     .typical = 1.5,
     .low = 1,
     .high = 20,
     .standard = 1},
    {.name = "sd_um",
     .unit = "um",
     .help = "standard deviation of the other touches",
     .typical = 0.5,
     .low = 0,
     .high = 50,
     .standard = 0.5,
     .linear = true},
    {.name = "group",
     .unit = "code",
     .help = "which touches scatter more: 0 those with long styli, 1 with the head tilted by more "
             "than 1 degree, 2 with fast probing, 3 with one orientation of the head, 4 on one feature, "
             "5 in one setup, 6 of one run, 7 in a stretch of time",
     .high = 7,
     .choices = kGroups},
    {.name = "longer_than_mm",
     .unit = "mm",
     .help = "limit of the stylus length for the group of long styli",
     .typical = 100,
     .low = 0,
     .high = 2000,
     .standard = 100,
     .only_with = {"group", "long styli"}},
    {.name = "faster_than_mm_s",
     .unit = "mm/s",
     .help = "limit of the probing speed for the group of fast probing",
     .typical = 5,
     .low = 0,
     .high = 1000,
     .standard = 5,
     .only_with = {"group", "fast probing"}},
    {.name = "head_a_deg",
     .unit = "deg",
     .help = "angle A of the head, for the group of one orientation",
     .typical = 90,
     .low = -180,
     .high = 180,
     .standard = 0,
     .only_with = {"group", "one orientation"}},
    {.name = "head_b_deg",
     .unit = "deg",
     .help = "angle B of the head, for the group of one orientation",
     .typical = 90,
     .low = -360,
     .high = 360,
     .standard = 0,
     .only_with = {"group", "one orientation"}},
    {.name = "feature",
     .unit = "1",
     .help = "which feature, counted in the order of their first touches, for the group of one feature",
     .typical = 1,
     .low = 1,
     .high = 1e6,
     .standard = 1,
     .only_with = {"group", "one feature"}},
    {.name = "setup",
     .unit = "1",
     .help = "number of the setup, for the group of one setup",
     .typical = 1,
     .low = 0,
     .high = 1e6,
     .standard = 1,
     .only_with = {"group", "one setup"}},
    {.name = "run",
     .unit = "1",
     .help = "number of the run of a recording, for the group of one run; a simulated program has none",
     .typical = 1,
     .low = 0,
     .high = 1e6,
     .standard = 1,
     .only_with = {"group", "one run"}},
    {.name = "from_s",
     .unit = "s",
     .help = "first moment of the stretch of time",
     .typical = 600,
     .low = 0,
     .high = 1e9,
     .standard = 0,
     .only_with = {"group", "a stretch of time"}},
    {.name = "to_s",
     .unit = "s",
     .help = "last moment of the stretch of time",
     .typical = 1200,
     .low = 0,
     .high = 1e9,
     .standard = 0,
     .only_with = {"group", "a stretch of time"}},
};

bool in_group(const TouchScene& scene, const double* theta) {
  switch (code(theta[2])) {
    case long_styli: return scene.stylus.length_mm > theta[3];
    case tilted_head: return std::fabs(scene.stylus.head_a_rad) > kUpright_rad;
    case fast_probing: return scene.speed_mm_s > theta[4];
    case one_orientation: return same_orientation(scene.stylus, theta[5] * kDegree, theta[6] * kDegree);
    case one_feature: return scene.feature + 1 == code(theta[7]);
    case one_setup: return scene.setup == code(theta[8]);
    case one_run: return scene.run == code(theta[9]);
    default: return scene.time_s >= theta[10] && scene.time_s <= theta[11];
  }
}

Vec3 unequal_noise(const TouchScene& scene, const double* theta, const double* z) {
  if (!in_group(scene, theta)) return {};
  const double missing_variance = std::fmax(0, theta[0] * theta[0] - 1);
  return along_normal(scene, theta[1] * kUm * std::sqrt(missing_variance) * z[0]);
}

}  // namespace

constinit const Effect kUnequalNoise{
    .name = "noise.unequal",
    .title = "unequal scatter",
    .help =
        "Some touches scatter more than others: those with long styli, with a tilted head, at high "
        "speed, with one orientation of the head that does not hold well, on a rough surface, in a setup "
        "in which the part is not held well, or made while something shook the machine. One standard deviation for all then gives too much weight to the bad ones "
        "and hides the good ones.",
    .source = "JCGM 100:2008 5.1.2; probe data sheets (scatter against stylus length and speed)",
    .separate = "repeat one touch many times in each group",
    .influence = "vibration and outliers",
    .stage = Stage::noise,
    .needs = Covariate::normal | Covariate::sensor,
    .parameters = kUnequalNoiseParameters,
    .draws_per = DrawsPer::touch,
    .draws = 1,
    .linear_in_draws = true,
    .displace = unequal_noise,
};

}  // namespace abbe
