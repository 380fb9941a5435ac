// A displacement that follows one coordinate of the touch: time, place along an axis of the machine,
// temperature of the part, speed.
//
//   d = sum over the knots k of w_k(s) ((x_k, y_k, z_k) + r_k n),     s = (coordinate - from) / (to - from)
//
// w_k: linear interpolation between kCurveKnots evenly spaced knots, constant beyond the ends. Linear in all
// knots. A step, a trend or a slow cycle of up to seven periods is drawn well enough by it.
#include <algorithm>
#include <array>

#include "engine/effects/empirical/empirical.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {

double curve_coordinate(const TouchScene& s, CurveCoordinate c) {
  switch (c) {
    case CurveCoordinate::time: return s.time_s;
    case CurveCoordinate::x: return s.point.x;
    case CurveCoordinate::y: return s.point.y;
    case CurveCoordinate::z: return s.point.z;
    case CurveCoordinate::part_temperature: return s.temperature.part;
    case CurveCoordinate::speed: return s.speed_mm_s;
  }
  return 0;
}

namespace {

constexpr std::string_view kAlong[] = {"time", "x", "y", "z", "part_temperature", "speed"};
constexpr int kFirstKnot = 3, kOfKnot = 4;
constexpr std::string_view kKnotNames[] = {
    "x0_um",  "y0_um",  "z0_um",  "r0_um",  "x1_um",  "y1_um",  "z1_um",  "r1_um",  "x2_um",  "y2_um",  "z2_um",
    "r2_um",  "x3_um",  "y3_um",  "z3_um",  "r3_um",  "x4_um",  "y4_um",  "z4_um",  "r4_um",  "x5_um",  "y5_um",
    "z5_um",  "r5_um",  "x6_um",  "y6_um",  "z6_um",  "r6_um",  "x7_um",  "y7_um",  "z7_um",  "r7_um",  "x8_um",
    "y8_um",  "z8_um",  "r8_um",  "x9_um",  "y9_um",  "z9_um",  "r9_um",  "x10_um", "y10_um", "z10_um", "r10_um",
    "x11_um", "y11_um", "z11_um", "r11_um", "x12_um", "y12_um", "z12_um", "r12_um", "x13_um", "y13_um", "z13_um",
    "r13_um", "x14_um", "y14_um", "z14_um", "r14_um", "x15_um", "y15_um", "z15_um", "r15_um"};
static_assert(std::size(kKnotNames) == kOfKnot * kCurveKnots);

constexpr auto kEmpiricalCurveParameters = [] {
  std::array<EffectParameter, kFirstKnot + kOfKnot * kCurveKnots> list{};
  list[0] = {.name = "along", .unit = "code", .help = "the coordinate that it follows", .high = 5, .choices = kAlong};
  list[1] = {.name = "from",
             .unit = "s, mm, degrees C or mm/s",
             .help = "the coordinate of the first knot",
             .low = -1e9,
             .high = 1e9};
  list[2] = {.name = "to",
             .unit = "s, mm, degrees C or mm/s",
             .help = "the coordinate of the last knot",
             .low = -1e9,
             .high = 1e9,
             .standard = 1};
  for (int k = 0; k < kOfKnot * kCurveKnots; ++k)
    list[static_cast<std::size_t>(kFirstKnot + k)] = {
        .name = kKnotNames[k],
        .unit = "um",
        .help = "displacement at this knot: x, y, z in W, r along the outward normal",
        .typical = 1,
        .low = -1e4,
        .high = 1e4,
        .linear = true};
  return list;
}();

Vec3 empirical_curve(const TouchScene& scene, const double* theta, const double*) {
  const double span = theta[2] - theta[1];
  if (span == 0) return {};
  const double at = curve_coordinate(scene, static_cast<CurveCoordinate>(code(theta[0])));
  const double s = std::clamp((at - theta[1]) / span, 0.0, 1.0) * (kCurveKnots - 1);
  const int k = std::min(static_cast<int>(s), kCurveKnots - 2);
  const double* a = theta + kFirstKnot + kOfKnot * k;
  const double* b = a + kOfKnot;
  const double w = s - k;
  return kUm * ((1 - w) * Vec3{a[0], a[1], a[2]} + w * Vec3{b[0], b[1], b[2]}) +
      along_normal(scene, kUm * ((1 - w) * a[3] + w * b[3]));
}

bool beyond_empirical_curve(const TouchScene& scene, const double* theta) {
  return beyond_knots(curve_coordinate(scene, static_cast<CurveCoordinate>(code(theta[0]))), theta[1], theta[2],
                      kCurveKnots);
}

std::string_view empirical_curve_contradiction(const double* theta) {
  return theta[1] == theta[2] ? "a curve needs two ends: from and to are the same" : "";
}

constexpr auto kNeighbouringKnots = [] {
  std::array<Neighbours, kOfKnot*(kCurveKnots - 1)> list{};
  for (std::size_t k = 0; k < list.size(); ++k) list[k] = {kFirstKnot + k, kFirstKnot + k + kOfKnot};
  return list;
}();

}  // namespace

constinit const Effect kEmpiricalCurve{
    .name = "empirical.curve",
    .title = "empirical: a displacement along one coordinate",
    .help =
        "A curve that a diagnosis has fitted to a mismatch which no effect of the catalogue explains: piecewise linear in time, along one axis "
        "of the machine, in the temperature of the part or in the speed. It is constant beyond the range of the recording that it was fitted to.",
    .source = "none: a fit to a recording",
    .separate = "find the physics: what `abbe diagnose` proposes to measure next",
    .stage = Stage::structure,
    .needs = 0,
    .parameters = kEmpiricalCurveParameters,
    .neighbours = kNeighbouringKnots,
    .contradiction = empirical_curve_contradiction,
    .displace = empirical_curve,
    .beyond = beyond_empirical_curve,
};

}  // namespace abbe
