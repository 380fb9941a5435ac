// Form error of the tip ball.
//
//   r = amplitude * sum over l = 2..6, m = -l..l of  z_lm w_l Y_lm(u),    u = - R_WR^T n,   w_l ~ 1/l^2
//
// u is the place of the ball that touches, in the frame of the head's last link: the form turns
// with the stylus. Y_lm are the real orthonormal spherical harmonics; degrees 0 and 1 are absent
// because radius and centre are qualified. z_lm are drawn once per machine. The weights are those of a
// smooth surface, whose slopes have a finite mean square: lapping leaves ovality and a few lobes, and
// little of higher degrees. They make the expected square over the ball amplitude^2, so
// `amplitude_um` is the rms form error.
// Size: grade 5 balls deviate by 0.13 um, grade 3 by 0.08 um (range); worn ones by micrometres.
// Confused with: probe.pretravel_lobing and probe.stylus_bending (degree 2), squareness when only
// one sphere was measured.
#include <array>

#include "engine/effects/probe/probe.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

constexpr int kLowest = 2, kHighest = 6;
constexpr int kTipTerms = (kHighest + 1) * (kHighest + 1) - kLowest * kLowest;
/// Place of (l, m) in the list of draws.
constexpr int term(int l, int m) { return l * l + l + m - kLowest * kLowest; }

constexpr EffectParameter kTipFormParameters[] = {
    {.name = "amplitude_um",
     .unit = "um",
     .help = "rms over the ball of its deviation from a sphere",
     .typical = 0.1,
     .low = -5,
     .high = 5,
     .linear = true},
    kSensorParameter,
};

/// Normalisation of Y_lm times the weight of degree l, by l and m >= 0.
using Norms = std::array<std::array<double, kHighest + 1>, kHighest + 1>;
Norms norms() {
  double square = 0;
  for (int l = kLowest; l <= kHighest; ++l) square += (2 * l + 1) / (4 * kPi) / (l * l * l * l);
  Norms norm{};
  for (int l = kLowest; l <= kHighest; ++l)
    for (int m = 0; m <= l; ++m) {
      double factorials = 1;
      for (int i = l - m + 1; i <= l + m; ++i) factorials *= i;
      norm[l][m] = std::sqrt((2 * l + 1) / (4 * kPi) * (m == 0 ? 1 : 2) / factorials / square) / (l * l);
    }
  return norm;
}
const Norms kNorms = norms();

/// The form at the place `u` of the ball, in units of its rms: associated Legendre functions by
/// upward recurrence in l.
double form(const Vec3& u, const double* z) {
  double sum = 0, start = 1, c = 1, s = 0;  // c + i s = (u.x + i u.y)^m;  start = (2m - 1)!!
  for (int m = 0; m <= kHighest; ++m) {
    double before = 0, p = start;
    for (int l = m; l <= kHighest; ++l) {
      if (l >= kLowest) {
        const double angular = m == 0 ? z[term(l, 0)] : z[term(l, m)] * c + z[term(l, -m)] * s;
        sum += kNorms[l][m] * p * angular;
      }
      const double next = ((2 * l + 1) * u.z * p - (l + m) * before) / (l - m + 1);
      before = p;
      p = next;
    }
    start *= 2 * m + 1;
    const double turned = c * u.x - s * u.y;
    s = c * u.y + s * u.x;
    c = turned;
  }
  return sum;
}

Vec3 tip_form(const TouchScene& scene, const double* theta, const double* z) {
  if (!concerns(scene.stylus, theta[1])) return {};
  const Vec3 touching = -(transpose(scene.stylus.R_WR) * scene.normal);
  return along_normal(scene, theta[0] * kUm * form(touching, z));
}

}  // namespace

constinit const Effect kTipForm{
    .name = "probe.tip_form",
    .title = "form error of the tip ball",
    .help =
        "The ball is not round: where it is proud the surface seems too far out. The deviation "
        "depends on the place of the ball that touches, so it turns with the stylus and repeats "
        "exactly. Degrees 2 to 6 of a random form are drawn for each machine.",
    .source = "ball grades after ISO 3290 (grade 5: 0.13 um, grade 3: 0.08 um); real spherical harmonics",
    .separate =
        "unscrew the stylus a little in the probe: the ball's form moves with the stylus, the "
        "lobing stays with the probe; two stylus lengths",
    .influence = "tip size and form",
    .stage = Stage::probe,
    .needs = Covariate::normal | Covariate::head,
    .parameters = kTipFormParameters,
    .draws_per = DrawsPer::machine,
    .draws = kTipTerms,
    .linear_in_draws = true,
    .displace = tip_form,
};

}  // namespace abbe
