// Error of a scale within its signal period.
//
//   d_i = a1 sin(2 pi x/p + f1) + a2 sin(4 pi x/p + f2),     p: signal period
//
// x: raw reading of axis i where it stops. From offset, unequal gain and phase of the two sensor signals (first
// and second harmonic).
// Size: TONiC < 0.03 um, RGH25F 0.05 um at 20 um; about 1 % of the period at most: LIDA 4xx 0.2 um
// at 20 um, LIDA 2xx 2 um at 200 um. Looks like noise against x, clear when folded to one period;
// so it needs raw scale readings.
// Confused with nothing else in the list (rho < 0.6).
#include "engine/effects/machine/machine.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

constexpr double kSignalPeriods_um[] = {2, 4, 5, 8, 10, 16, 20, 32, 40, 50, 64, 100, 128, 200};

constexpr EffectParameter kScaleInterpolationParameters[] = {
    {.name = "amplitude_um",
     .unit = "um",
     .help = "first harmonic of the signal period",
     .typical = 0.1,
     .low = -10,
     .high = 10,
     .linear = true},
    {.name = "second_um",
     .unit = "um",
     .help = "second harmonic of the signal period",
     .typical = 0.05,
     .low = -10,
     .high = 10,
     .linear = true},
    {.name = "period_um",
     .unit = "um",
     .help = "signal period of the scale",
     .typical = 20,
     .low = 0.1,
     .high = 2000,
     .standard = 20,
     .sought = Sought::signal_period,
     .tried = kSignalPeriods_um},
    axis_parameter("the scale: 0 x, 1 y, 2 z"),
    {.name = "phase_deg",
     .unit = "deg",
     .help = "phase of the first harmonic at reading zero",
     .typical = 0,
     .low = -360,
     .high = 360,
     .sought = Sought::phase},
    {.name = "second_phase_deg",
     .unit = "deg",
     .help = "phase of the second harmonic at reading zero",
     .typical = 0,
     .low = -360,
     .high = 360,
     .sought = Sought::phase},
};

Vec3 scale_interpolation(const TouchScene& scene, const double* theta, const double*) {
  const int axis = code(theta[3]);
  const double periods = scene.reading[axis] / (theta[2] * kUm);
  const double angle = 2 * kPi * (periods - std::floor(periods));
  const double error_um =
      theta[0] * std::sin(angle + theta[4] * kDegree) + theta[1] * std::sin(2 * angle + theta[5] * kDegree);
  return error_um * kUm * axis_vector(axis);
}

std::string_view scale_interpolation_contradiction(const double* theta) {
  const double steepest = 2 * kPi * (std::abs(theta[0]) + 2 * std::abs(theta[1])) / theta[2];
  return steepest < 1 ? "" : "with such an amplitude the scale would read backwards within its period";
}

}  // namespace

constinit const Effect kScaleInterpolation{
    .name = "machine.scale_interpolation",
    .title = "scale error within the signal period",
    .help =
        "The electronics divides each period of the scale's signal a little unevenly, so the "
        "reading errs with the period of the scale. It limits short steps and looks like noise "
        "anywhere else, until readings are folded to one period.",
    .source =
        "encoder data sheets: TONiC 0.03 um, RGH25F 0.05 um, LIDA 4xx 0.2 um at 20 um, LIDA 2xx 2 "
        "um at 200 um",
    .separate = "step along the axis by an eighth of the period; full-resolution scale readings",
    .influence = "scale interpolation",
    .stage = Stage::scale,
    .needs = 0u | Covariate::raw_reading,
    .parameters = kScaleInterpolationParameters,
    .contradiction = scale_interpolation_contradiction,
    .displace = scale_interpolation,
};

}  // namespace abbe
