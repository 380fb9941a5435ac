#include "engine/diagnose/warnings.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "engine/diagnose/quantile.hpp"
#include "engine/math/units.hpp"

namespace abbe::diagnose {

double within_mm(const RecordedTouches& t, double share) {
  std::vector<double> size;
  for (const RecordedTouch& touch : t.touches) size.push_back(std::abs(touch.residual_mm));
  return quantile(std::move(size), share);
}

bool scatters_more(const BaselineSummary& b, int touches) {
  constexpr double kSure = 3;  // standard uncertainties
  return b.noise_um * (1 - kSure / std::sqrt(2.0 * touches)) > b.stated_noise_um &&
      b.noise_um > kLeastExcess * b.stated_noise_um;
}

Diagnostic not_its_targets(const RecordedTouches& t, double share, const std::string& file) {
  return diagnostic(
      Code::W0704,
      fmt::format(
          "{}: {} of the touches lie more than {:.2g} mm from the targets: the part is not what the targets say. "
          "Every surface point counts as unknown, and only what repeats differently is judged",
          file, share == kHalfOfThem ? "half" : "a tenth", within_mm(t, share)),
      "give measured or calibrated targets, or say '# surfaces: calibrated' if the targets are right");
}

Diagnostic nothing_but_targets(const std::string& file) {
  return diagnostic(
      Code::W0717, fmt::format("{}: every touch is exactly where an error-free machine has it", file),
      "a real machine differs in the last digits: check that measured positions were recorded, and not targets");
}

Diagnostic beyond_its_specification(const LengthError& e, bool beside_names, const std::string& file) {
  return diagnostic(
      Code::W0716,
      fmt::format(
          "{}: {}lengths of {:.0f} mm between touches are wrong by {:.1f} um, and the specification of the machine allows {:.1f} um",
          file, beside_names ? "beside what was named, " : "", e.length_mm, kUmPerMm * e.error_mm, kUmPerMm * e.mpe_mm),
      "have the machine tested (ISO 10360-2), check the calibration of the part, and its temperature");
}

Diagnostic large_errors(double times, const Deviations& rms, const std::string& file) {
  return diagnostic(
      Code::W0723,
      fmt::format(
          "{}: it agrees only with a machine whose geometric errors are {:.1f} times those of its specification, or rougher: the touches deviate by {:.2g} um rms, where machines of the specification deviate by {:.2g} um",
          file, times, rms.recorded_um, rms.specified_um),
      "a machine out of its specification, or an effect that looks like its geometry: measure calibrated lengths (ISO 10360-2), or the same part in another place");
}

Diagnostic another_machine(double times, const std::string& file) {
  return diagnostic(
      Code::W0720,
      fmt::format("{}: beside what was found, the machine differs by {:.1f} times what its file leaves uncertain", file,
                  times),
      "it is another machine than the file knows, or one that has changed as a whole: diagnose with a machine file that has no known_state, and write its state anew with --model-out");
}

Diagnostic more_scatter(const BaselineSummary& b, const std::string& file) {
  return diagnostic(
      Code::W0730,
      fmt::format("{}: the touches scatter by {:.2f} um, {:.1f} times as much as the machine file says ({:.2f} um)",
                  file, b.noise_um, b.noise_um / b.stated_noise_um, b.stated_noise_um),
      "touch one point again and again, in several directions: if it repeats as badly, the probe or the machine is worse than its file; if not, something is at work that so few touches do not show");
}

}  // namespace abbe::diagnose
