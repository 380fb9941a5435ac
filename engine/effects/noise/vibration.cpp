// Vibration of machine and floor.
//
//   d = sd z u  (one direction)   or   r = sd z  (every way)     z: standard normal per touch
//
// A lightly damped structure moves as a narrow-band process, an AR(2) in time: correlation exp(-c w
// t) cos(w t) after t. With 10 to 50 Hz and 2 % of critical damping it is forgotten after 1 / (c w)
// = 0.2 to 0.8 s, while touches are 1 to 10 s apart: the touches alias it, and what they see is
// white. Its mark is the direction: a mode shakes one axis, so the spread grows with |n . u|.
// Size: 0.1 to 1 um. Source: damped oscillator under random excitation; ISO 10360-2 asks for the
// maker's limits of vibration.
// Confused with: the probe's own repeatability when it shakes every way.
#include "engine/effects/noise/noise.hpp"

namespace abbe {
namespace {

constexpr int kEveryWay = 3;
constexpr std::string_view kDirections[] = {"x", "y", "z", "every way"};

constexpr EffectParameter kVibrationParameters[] = {
    {.name = "sd_um",
     .unit = "um",
     .help = "standard deviation of the displacement in its direction",
     .typical = 0.3,
     .low = 0,
     .high = 50,
     .linear = true},
    {.name = "direction",
     .unit = "code",
     .help = "axis that shakes: 0 x, 1 y, 2 z; 3: every way, the same along any normal",
     .typical = 3,
     .high = 3,
     .standard = 3,
     .choices = kDirections},
};

Vec3 vibration(const TouchScene& scene, const double* theta, const double* z) {
  const int direction = code(theta[1]);
  return theta[0] * kUm * z[0] * (direction == kEveryWay ? scene.normal : axis_vector(direction));
}

}  // namespace

constinit const Effect kVibration{
    .name = "noise.vibration",
    .title = "vibration",
    .help =
        "Floor, drives or air bearings shake the machine, and each touch catches it at another "
        "phase: more scatter, usually in one direction. Touches are too far apart in time to "
        "follow the oscillation itself. Forms grow; means of many touches hardly change.",
    .source = "damped oscillator under random excitation; environmental conditions of ISO 10360-2",
    .separate =
        "repeat one touch many times along each axis; the same with neighbouring machines "
        "switched off",
    .influence = "vibration and outliers",
    .stage = Stage::noise,
    .needs = 0u | Covariate::normal,
    .parameters = kVibrationParameters,
    .draws_per = DrawsPer::touch,
    .draws = 1,
    .linear_in_draws = true,
    .displace = vibration,
};

}  // namespace abbe
