// Pretravel of a kinematic touch-trigger probe from the statics of its tripod.
//
// The stylus holder rests on three seats at radius R, pressed down by a spring Fs. A force F along
// n at the tip t = -L s tips it about the edge k with inner normal e_k (at 0, 120, 240 degrees +
// phase, in the plane across the axis b of the probe body) when
//   F [ w . e_k + (R/2) n.b ] = Fs R/2 (1 + g Z . e_k),     w = b x (t x n)
// where w is the lever of the force; for a straight stylus |w| = L cos(beta). The weakest edge
// decides: F = min over k. Until then the stylus bends by F cos^2(beta) L^3/(3 E I), and so the
// pretravel p ~ cos^2(beta) L^3 / max_k [...] follows: three-lobed with a 1/cos law, not cos 3 phi.
// Round the equator max/min = 2, harmonics relative to the mean: 3rd -27.5 %, 6th +10.4 %, 9th -5.4
// %; p ~ L^2; p ~ 0 at the pole. (Axial stiffness and seats, a few per cent of the bending, are
// left out.) g: weight of the moving parts times its distance from the seats over Fs R/2; it
// matters when the body lies (A = 90).
//   r = -(p - mean p over the qualification),
// the mean being that over the hemisphere of directions. `amplitude_um` is half the range of p
// round the equator for a stylus of `at_length_mm`. e_k turns with the probe body (R_WR).
// Sources: Estler et al. 1996/1997 (NIST; gravity, bending, friction), Shen & Springer 1998 (16 um
// range with 50 mm); derivation above.
// Confused with: forms of three lobes of the reference sphere or the tip; the elevation term with
// probe.stylus_bending.
#include <algorithm>
#include <array>

#include "engine/effects/probe/probe.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

/// The three seats repeat after 120 degrees.
constexpr double kPhases_deg[] = {-45, -30, -15, 0, 15, 30, 45, 60};

constexpr EffectParameter kPretravelLobingParameters[] = {
    {.name = "amplitude_um",
     .unit = "um",
     .help = "half the range of the pretravel round the equator, for a stylus of at_length_mm",
     .typical = 1,
     .low = 0,
     .high = 50,
     .linear = true},
    {.name = "phase_deg",
     .unit = "deg",
     .help = "azimuth of one of the three soft directions, towards which the surface pushes the tip, about "
             "the body's axis from x of the head's last link; repeats after 120 degrees",
     .typical = 0,
     .low = -180,
     .high = 180,
     .sought = Sought::around_listed,
     .tried = kPhases_deg},
    {.name = "at_length_mm",
     .unit = "mm",
     .help = "stylus length for which amplitude_um is given",
     .typical = 50,
     .low = 5,
     .high = 500,
     .standard = 50},
    {.name = "seat_radius_mm",
     .unit = "mm",
     .help = "radius of the three seats; sets the dependence on elevation near the pole",
     .typical = 4,
     .low = 0.5,
     .high = 20,
     .standard = 4},
    {.name = "gravity_share",
     .unit = "1",
     .help = "moment of the moving parts' weight with the body lying, over that of the spring",
     .typical = 0,
     .low = 0,
     .high = 0.5},
};

/// Statics of one probe. The relative pretravel is that over the smallest of the equator: 1 to 2
/// there.
struct Tripod {
  double half_radius_mm, gravity;
  double cos_phase, sin_phase;

  double relative_pretravel(const TouchScene& scene) const;
};

double Tripod::relative_pretravel(const TouchScene& scene) const {
  const StylusScene& stylus = scene.stylus;
  const Mat3& R = stylus.R_WR;
  const Vec3& n = scene.normal;
  const Vec3 lever = cross(R.cz, cross(-1.0 * stylus.to_head, n));  // per length of the stylus
  const double lx = dot(lever, R.cx), ly = dot(lever, R.cy), axial = half_radius_mm / stylus.length_mm * dot(n, R.cz);
  const double along = dot(n, stylus.to_head), across2 = 1 - along * along;
  // The floor bounds the directions in which such a probe hardly triggers: pulls along its body and
  // twists about it.
  const double floor = 0.25 * std::sqrt(std::max(0.0, across2));
  if (floor < 1e-6) return 0;
  constexpr double kC[3] = {1, -0.5, -0.5}, kS[3] = {0, 0.86602540378443865, -0.86602540378443865};
  double force = 1e300;
  for (int k = 0; k < 3; ++k) {
    const double c = cos_phase * kC[k] - sin_phase * kS[k], s = sin_phase * kC[k] + cos_phase * kS[k];
    const double restoring = 1 + gravity * (c * R.cx.z + s * R.cy.z);
    force = std::min(force, restoring / std::max(c * lx + s * ly + axial, floor));
  }
  return across2 * force;
}

/// Gauss points of the mean over the hemisphere: three in azimuth (a sixth of the circle), four in
/// elevation.
struct Direction {
  double across, along, azimuth_cos, weight;
};

std::array<Direction, 12> hemisphere() {
  constexpr double kNode3[] = {-0.7745966692414834, 0, 0.7745966692414834}, kWeight3[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  constexpr double kNode4[] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526};
  constexpr double kWeight4[] = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461, 0.3478548451374538};
  std::array<Direction, 12> points{};
  for (int i = 0; i < 12; ++i) {
    const double elevation = kPi / 4 * (1 + kNode4[i / 3]);
    points[i] = {std::cos(elevation), std::sin(elevation), std::cos(kPi / 6 * (1 + kNode3[i % 3])),
                 kWeight3[i % 3] * kWeight4[i / 3] * kPi / 4 * std::cos(elevation)};
  }
  return points;
}
const std::array<Direction, 12> kHemisphere = hemisphere();

/// The mean of the relative pretravel of a straight stylus; `tilt` = R / (2 L). Gravity cancels out
/// of it to first order.
double mean_over_qualification(double tilt) {
  double mean = 0;
  for (const Direction& d : kHemisphere)
    mean += d.weight * d.across * d.across / (d.across * d.azimuth_cos + tilt * d.along);
  return mean;
}

Vec3 pretravel_lobing(const TouchScene& scene, const double* theta, const double*) {
  const double length = scene.stylus.length_mm;
  if (length <= 0) return {};  // a touch without a stylus: the recording does not tell which
  const double phase = theta[1] * kDegree, growth = length / theta[2];
  const Tripod tripod{0.5 * theta[3], theta[4], std::cos(phase), std::sin(phase)};
  const double p = tripod.relative_pretravel(scene) - mean_over_qualification(tripod.half_radius_mm / length);
  return along_normal(scene, -2 * theta[0] * kUm * growth * growth * p);
}

}  // namespace

constinit const Effect kPretravelLobing{
    .name = "probe.pretravel_lobing",
    .title = "three-lobed pretravel of a kinematic probe",
    .help =
        "A touch-trigger probe with three seats needs twice the force in its stiff directions that "
        "it needs in the soft ones, so the stylus bends more before the trigger there. Rings and "
        "spheres show three lobes that turn with the probe body; the error grows with the square "
        "of the stylus length and vanishes when the touch is along the stylus. The mean is "
        "contained in the qualified tip radius.",
    .source =
        "Estler et al., Precision Engineering 19 (1996) and NIST (1997); Shen & Springer, J. "
        "Manuf. Sci. Eng. 120 (1998): 16 um range with 50 mm",
    .separate =
        "turn the head by B = 60 degrees: the lobes turn with it and those of the part stay; two "
        "stylus lengths; turn the reference sphere; a ring and a sphere",
    .influence = "probe pretravel lobing",
    .stage = Stage::probe,
    .needs = Covariate::normal | Covariate::head | Covariate::sensor,
    .parameters = kPretravelLobingParameters,
    .displace = pretravel_lobing,
};

}  // namespace abbe
