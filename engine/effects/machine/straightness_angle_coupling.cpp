// Straightness and angle of a carriage come from the same rail (Bryan's relation of the bearing
// base).
//
//   e_j(x) = [ f(x + b/2) + f(x - b/2) ] / 2,     slope(x) = [ f(x + b/2) - f(x - b/2) ] / b
//   d = sum over the two directions j across the axis of   e_j j + slope (i x j) x lever
//
// f: profile of the rail in direction j; b: distance of the carriage's bearings; i: the moving
// axis. For wavelengths >> b the angle is the derivative of the straightness; the geometric model
// draws the two independently, a simplification that it names itself. Here a random rail is drawn,
// f = amplitude sum a_n [z cos(k_n x) + z' sin(k_n x)], k_n = 2 pi n / travel, n = 1..7, a_n ~ 1/n,
// rms 1, and both errors follow from it.
// Size: 1 to 5 um of rail. Seen not in a mean but in the covariance: e_j is the integral of slope.
// Confused with: the machine's own error functions, unless two Abbe offsets are measured on the
// same axis.
#include "engine/effects/machine/machine.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

constexpr int kRailHarmonics = 7;

constexpr double kBearingBases_mm[] = {200, 300, 500};

constexpr EffectParameter kStraightnessAngleCouplingParameters[] = {
    {.name = "amplitude_um",
     .unit = "um",
     .help = "rms of the rail's profile",
     .typical = 2,
     .low = -50,
     .high = 50,
     .linear = true},
    {.name = "bearing_base_mm",
     .unit = "mm",
     .help = "distance between the carriage's bearings along the rail",
     .typical = 300,
     .low = 20,
     .high = 2000,
     .standard = 300,
     .sought = Sought::listed,
     .tried = kBearingBases_mm},
    axis_parameter("the moving carriage: 0 x, 1 y, 2 z"),
};

/// Error of the carriage in one direction across its rail.
struct Carriage {
  double offset = 0, slope = 0;  ///< per amplitude; slope per mm
};

/// z: cos and sin coefficient of each harmonic. Multiples of the angles by the recurrence of the
/// cosine.
Carriage carriage(double k, double x, double half_base, const double* z) {
  constexpr double kRmsOfOneOverN = 1.2295516;  // sqrt(1 + 1/4 + ... + 1/49)
  const double c1 = std::cos(k * x), s1 = std::sin(k * x), cb1 = std::cos(k * half_base), sb1 = std::sin(k * half_base);
  double c = 1, s = 0, cb = 1, sb = 0;
  Carriage sum;
  for (int n = 1; n <= kRailHarmonics; ++n) {
    const double c_next = c * c1 - s * s1, cb_next = cb * cb1 - sb * sb1;
    s = s * c1 + c * s1, c = c_next;
    sb = sb * cb1 + cb * sb1, cb = cb_next;
    const double zc = z[2 * n - 2] / n, zs = z[2 * n - 1] / n;
    sum.offset += cb * (zc * c + zs * s);
    sum.slope += sb / half_base * (zs * c - zc * s);
  }
  return {sum.offset / kRmsOfOneOverN, sum.slope / kRmsOfOneOverN};
}

Vec3 straightness_angle_coupling(const TouchScene& scene, const double* theta, const double* z) {
  const int axis = code(theta[2]);
  const double k = 2 * kPi / scene.travel_length_mm[axis], x = scene.reading[axis];
  Vec3 d, rotation;
  for (int plane = 0; plane < 2; ++plane) {
    const Vec3 across = axis_vector((axis + 1 + plane) % 3);
    const Carriage e = carriage(k, x, 0.5 * theta[1], z + 2 * kRailHarmonics * plane);
    d += scene.side[axis] * e.offset * across;
    rotation += e.slope * cross(axis_vector(axis), across);
  }
  return theta[0] * kUm * (d + cross(rotation, scene.lever_mm[axis]));
}

}  // namespace

constinit const Effect kStraightnessAngleCoupling{
    .name = "machine.straightness_angle_coupling",
    .title = "straightness and angle from one rail",
    .help =
        "A carriage that follows a wavy rail shifts and tilts together: its angle is nearly the "
        "slope of its straightness. Machines with independent straightness and angles miss this; "
        "the effect adds coupled functions from a random rail profile and the distance of the "
        "bearings.",
    .source =
        "Bryan, Precision Engineering 1 (1979), the Abbe principle revisited; Hu et al., Machines "
        "9, 33 (2021)",
    .separate = "the same line measured with two Abbe offsets (stylus lengths or heights) on one axis",
    .influence = "geometry",
    .stage = Stage::structure,
    .needs = 0u | Covariate::position,
    .parameters = kStraightnessAngleCouplingParameters,
    .draws_per = DrawsPer::machine,
    .draws = 2 * 2 * kRailHarmonics,
    .linear_in_draws = true,
    .only_spread = true,
    .displace = straightness_angle_coupling,
};

}  // namespace abbe
