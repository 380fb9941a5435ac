// Errors of motion of the head's two axes in all six degrees of freedom.
//
//   d = u_B(B) + R_B u_A(A) + [w_B(B) + R_B w_A(A)] x t
//
// u: three translations, w: three rotations of an axis as functions of its angle; t: from the
// head's centre to the tip; R_B carries the errors of A, the axis nearer to the stylus. Each
// function is
//   a (cos q - 1) + b sin q + [c (cos 2q - 1) + d sin 2q] / 2
// with coefficients drawn once per machine: u in units of `translation_um`, w of `rotation_urad`.
// It is zero at A = B = 0, the orientation from which offsets are computed. Axes that do not
// intersect or are not square are the first harmonics of u_B and w_B.
// Size: tens of um for computed orientations, next to nothing for those qualified one by one. ISO
// 10360-5 tests five orientations.
// Confused with: probe.stylus_length (rho 0.8 to 0.9), thermal.stylus_growth, head.qualification.
#include "engine/effects/head/head.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

constexpr int kBasis = 4, kDrawsPerAxis = 6 * kBasis;

constexpr EffectParameter kHeadAxisErrorsParameters[] = {
    {.name = "translation_um",
     .unit = "um",
     .help = "standard deviation of the harmonics of the axes' translations",
     .typical = 3,
     .low = -200,
     .high = 200,
     .linear = true},
    {.name = "rotation_urad",
     .unit = "urad",
     .help = "standard deviation of the harmonics of the axes' rotations",
     .typical = 20,
     .low = -2000,
     .high = 2000,
     .linear = true},
};

struct Motion {
  Vec3 translation, rotation;
};

/// The six functions of one axis at its angle; z: translations x, y, z, then rotations, four
/// coefficients each.
Motion motion(double angle_rad, const double* z) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  const double basis[kBasis] = {c - 1, s, -s * s, s * c};  // the last two: (cos 2q - 1) / 2, sin 2q / 2
  double f[6];
  for (int i = 0; i < 6; ++i) {
    f[i] = 0;
    for (int h = 0; h < kBasis; ++h) f[i] += z[kBasis * i + h] * basis[h];
  }
  return {{f[0], f[1], f[2]}, {f[3], f[4], f[5]}};
}

Vec3 head_axis_errors(const TouchScene& scene, const double* theta, const double* z) {
  const StylusScene& stylus = scene.stylus;
  if (!stylus.indexed) return {};
  const Motion a = motion(stylus.head_a_rad, z), b = motion(stylus.head_b_rad, z + kDrawsPerAxis);
  const Mat3 R_B = frame_after_b(stylus);
  const Vec3 translation = b.translation + R_B * a.translation, rotation = b.rotation + R_B * a.rotation;
  return theta[0] * kUm * translation + theta[1] * kUrad * cross(rotation, head_arm(stylus));
}

}  // namespace

constinit const Effect kHeadAxisErrors{
    .name = "head.axis_errors",
    .title = "error motions of the head's axes",
    .help =
        "The axes of the head wobble, do not meet and are not square, so the tip of a computed "
        "orientation is off by a constant vector that repeats whenever the orientation returns. "
        "Translations are the same for all styli, rotations grow with the stylus length. "
        "Orientations that are qualified one by one do not show it.",
    .source =
        "ISO 230-7 error motions of rotary axes; ISO 10360-5 multi-stylus test; Van Gestel, Bleys "
        "& Kruth, section 8.2",
    .separate =
        "return to each orientation several times, out of order, on a fixed sphere; a second "
        "stylus length splits translations from rotations",
    .influence = "head geometry and qualification",
    .stage = Stage::head,
    .needs = 0u | Covariate::head,
    .parameters = kHeadAxisErrorsParameters,
    .draws_per = DrawsPer::machine,
    .draws = 2 * kDrawsPerAxis,
    .linear_in_draws = true,
    .displace = head_axis_errors,
};

}  // namespace abbe
