// A displacement along the normal that depends on the direction of the normal, seen from the machine or from the probe.
//
//   r = sum over all monomials of degree 3 and 4 of c x^i y^j z^k,     (x, y, z) the outward unit normal
//
// On the sphere the monomials of degree 4 span the even harmonics up to degree 4, those of degree 3 the odd
// ones up to 3.
#include <array>

#include "engine/effects/empirical/empirical.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

constexpr std::string_view kFrames[] = {"machine", "probe"};
constexpr int kFirstTerm = 1;
constexpr std::string_view kTerms[] = {"xxx",  "xxy",  "xxz",  "xyy",  "xyz",  "xzz",  "yyy",  "yyz",  "yzz",
                                       "zzz",  "xxxx", "xxxy", "xxxz", "xxyy", "xxyz", "xxzz", "xyyy", "xyyz",
                                       "xyzz", "xzzz", "yyyy", "yyyz", "yyzz", "yzzz", "zzzz"};
constexpr std::string_view kNames[] = {"xxx_um",  "xxy_um",  "xxz_um",  "xyy_um",  "xyz_um",  "xzz_um",  "yyy_um",
                                       "yyz_um",  "yzz_um",  "zzz_um",  "xxxx_um", "xxxy_um", "xxxz_um", "xxyy_um",
                                       "xxyz_um", "xxzz_um", "xyyy_um", "xyyz_um", "xyzz_um", "xzzz_um", "yyyy_um",
                                       "yyyz_um", "yyzz_um", "yzzz_um", "zzzz_um"};
static_assert(std::size(kTerms) == kDirectionTerms && std::size(kNames) == kDirectionTerms);

constexpr auto kEmpiricalDirectionParameters = [] {
  std::array<EffectParameter, kFirstTerm + kDirectionTerms> list{};
  list[0] = {.name = "frame", .unit = "code", .help = "whose axes x, y, z are", .high = 1, .choices = kFrames};
  for (int k = 0; k < kDirectionTerms; ++k)
    list[static_cast<std::size_t>(kFirstTerm + k)] = {.name = kNames[k],
                                                      .unit = "um",
                                                      .help = "coefficient of this product of components",
                                                      .typical = 1,
                                                      .low = -1e4,
                                                      .high = 1e4,
                                                      .linear = true};
  return list;
}();

Vec3 empirical_direction(const TouchScene& scene, const double* theta, const double*) {
  const Vec3 n = code(theta[0]) == 0 ? scene.normal : transpose(scene.stylus.R_WR) * scene.normal;
  double r_um = 0;
  for (int k = 0; k < kDirectionTerms; ++k) {
    double term = theta[kFirstTerm + k];
    for (const char axis : kTerms[k]) term *= n[axis - 'x'];
    r_um += term;
  }
  return along_normal(scene, kUm * r_um);
}

}  // namespace

constinit const Effect kEmpiricalDirection{
    .name = "empirical.direction",
    .title = "empirical: an error that depends on the direction of the surface",
    .help =
        "A smooth function of the outward normal that a diagnosis has fitted to a mismatch which no effect of the catalogue explains.",
    .source = "none: a fit to a recording",
    .separate = "find the physics: what `abbe diagnose` proposes to measure next",
    .stage = Stage::probe,
    .needs = 0u | Covariate::normal,
    .parameters = kEmpiricalDirectionParameters,
    .displace = empirical_direction,
};

}  // namespace abbe
