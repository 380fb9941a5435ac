// An offset of all touches with one stylus system, or with one orientation of the head:
//
//   d = (x, y, z) + r n     for that stylus or orientation,   else 0
#include <cmath>

#include "engine/effects/empirical/empirical.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

constexpr std::string_view kOf[] = {"sensor", "orientation"};

constexpr EffectParameter offset(std::string_view name, std::string_view help) {
  return {.name = name, .unit = "um", .help = help, .typical = 1, .low = -1e4, .high = 1e4, .linear = true};
}

constexpr EffectParameter kEmpiricalOffsetParameters[] = {
    {.name = "of", .unit = "code", .help = "what has the offset", .high = 1, .choices = kOf},
    kSensorParameter,
    {.name = "head_A_deg", .unit = "deg", .help = "of an orientation", .low = -360, .high = 360},
    {.name = "head_B_deg", .unit = "deg", .help = "of an orientation", .low = -360, .high = 360},
    offset("x_um", "in W"),
    offset("y_um", "in W"),
    offset("z_um", "in W"),
    offset("r_um", "along the outward normal"),
};

Vec3 empirical_offset(const TouchScene& scene, const double* theta, const double*) {
  constexpr double kSame = 1e-6;
  const StylusScene& s = scene.stylus;
  const bool turned =
      std::abs(s.head_a_rad - theta[2] * kDegree) < kSame && std::abs(s.head_b_rad - theta[3] * kDegree) < kSame;
  if (code(theta[0]) == 0 ? !concerns(s, theta[1]) : !turned) return {};
  return kUm * Vec3{theta[4], theta[5], theta[6]} + along_normal(scene, kUm * theta[7]);
}

}  // namespace

constinit const Effect kEmpiricalOffset{
    .name = "empirical.offset",
    .title = "empirical: an offset of one stylus or orientation",
    .help =
        "A constant displacement of every touch with one stylus system or in one orientation of the head, which a diagnosis has fitted to a "
        "mismatch that no effect of the catalogue explains.",
    .source = "none: a fit to a recording",
    .separate = "find the physics: what `abbe diagnose` proposes to measure next",
    .stage = Stage::head,
    .needs = 0u | Covariate::head | Covariate::sensor,
    .parameters = kEmpiricalOffsetParameters,
    .displace = empirical_offset,
};

}  // namespace abbe
