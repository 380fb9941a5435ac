// Rounding of a reading to the last digit.
//
//   r = q (U - 1/2),    U uniform in (0, 1), one per touch;    standard deviation q / sqrt(12)
//
// q is the step of the counter or of the software's output. The errors of a virtual machine are
// large against q or unknown within a step, so what rounding does to one reading is uniform within
// a step (Widrow's condition: spread of the readings above about q/2). That is what a run adds; a recording is written
// digit by digit, so `abbe record` rounds its positions instead.
// Size: 1 um 0.29 um; counters of 0.1 um 0.03 um. A recording that was rounded also shows it by its
// digits: exp(2 pi i y / q) has a mean length near one.
// Source: JCGM 100 F.2.2.1; Widrow & Kollar, Quantization Noise (2008).
// Confused with: any small white noise, unless the digits are looked at.
#include "engine/effects/noise/noise.hpp"
#include "engine/math/normal.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kResolutionParameters[] = {
    {.name = "resolution_um",
     .unit = "um",
     .help = "step of the readings",
     .typical = 0.5,
     .low = 0,
     .high = 100,
     .linear = true},
};

Vec3 resolution(const TouchScene& scene, const double* theta, const double* z) {
  return along_normal(scene, theta[0] * kUm * (normal_below(z[0]) - 0.5));
}

}  // namespace

constinit const Effect kResolution{
    .name = "noise.resolution",
    .title = "resolution of the readings",
    .help =
        "Readings are rounded to a step, by the counter of a scale or by the software that "
        "writes them. That adds a uniform error of one step in width, with a standard deviation "
        "of 0.29 steps. `abbe run` adds this error; `abbe record` rounds the positions and scale readings that it "
        "writes, and a diagnosis, which looks at the digits, finds the step.",
    .source = "JCGM 100:2008 F.2.2.1; Widrow & Kollar, Quantization Noise (2008)",
    .separate = "look at the digits: the readings fall on a grid; write more digits",
    .influence = "vibration and outliers",
    .stage = Stage::noise,
    .needs = 0u | Covariate::normal,
    .parameters = kResolutionParameters,
    .draws_per = DrawsPer::touch,
    .draws = 1,
    .displace = resolution,
};

}  // namespace abbe
