// noise.resolution: the positions of a recording have a divisor.
#include <fmt/format.h>
#include <cmath>

#include "engine/diagnose/findings/noise/noise_property.hpp"
#include "engine/effects/noise/noise.hpp"

namespace abbe::diagnose {

namespace {

std::optional<NoiseFinding> judge_resolution(Scatter& s) {
  const Case& c = s.c;
  constexpr double kStored_um = 1e-4;
  constexpr double kSame = 1e-3;
  if (c.rounding_um == 0) return std::nullopt;
  const auto known = in_machine_file(c, kResolution, "resolution_um");
  if (known && std::abs(known->value - c.step_um) <= kSame * c.step_um) return std::nullopt;
  // That every one of so many numbers has this divisor by chance is out of the question.
  NoiseFinding f{&kResolution, 1e-12, {figure("resolution_um", "um", c.step_um, kStored_um)}, {}};
  f.sentence = fmt::format("All recorded positions are multiples of {:g} um: the readings were rounded.", c.step_um);
  return f;
}

/// That all positions have a divisor is seen as soon as it counts beside the noise.
void plan_resolution(const ScatterDesign& design, Diagnosis& out) {
  Detectable d = smallest_of(kResolution, "resolution_um", "um");
  d.detect_um = kLeastRounding * design.noise_um(), d.name_um = d.detect_um;
  d.detect = d.detect_um * std::sqrt(12.0), d.name = d.detect;
  out.smallest_detectable.push_back(std::move(d));
}

}  // namespace

const NoiseProperty kJudgedResolution{&kResolution, false, judge_resolution, plan_resolution};

}  // namespace abbe::diagnose
