#include "engine/diagnose/values/value_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/diagnose/quantile.hpp"
#include "engine/math/units.hpp"

namespace abbe::diagnose {

void doubt_calibrations(const ValueCase& c, std::vector<Diagnostic>& messages) {
  constexpr double kTimes = 3;
  std::vector<double> times;
  for (Eigen::Index k = 0; k < c.deviation.size(); ++k) {
    const double calibrated = c.ensemble.values[static_cast<std::size_t>(k)].calibration,
                 of_both = std::sqrt(c.judges.covariance(k, k));
    times.push_back(
        calibrated /
        std::sqrt(std::max(of_both * of_both - calibrated * calibrated, kLeastOfValue_um * kLeastOfValue_um)));
  }
  const double middle = median(std::move(times));
  if (middle < kTimes) return;
  messages.push_back(diagnostic(
      Code::W0726,
      fmt::format("{}: by U the calibrated values are known {:.0f} times worse than the machine measures them",
                  c.recording->source.name(), middle),
      "U is the expanded uncertainty (k = 2) in mm or degrees, as the value is; as it stands, only errors larger than U show"));
}

bool holds_references_only(const ValueCase& c) {
  constexpr double kFinest_um = 1e-6;  // of doubles that were written with all digits
  constexpr double kHardly = 1e-4;
  double chance = 1;
  for (std::size_t k = 0; k < c.ensemble.values.size(); ++k) {
    const RecordedValue& v = c.ensemble.values[k];
    const auto at = static_cast<Eigen::Index>(k);
    const double digit = std::max(c.recording->rows[k].last_digit / v.reported(), kFinest_um);
    if (c.recording->rows[k].last_digit == 0 || std::abs(v.deviation) > digit / 2 + kFinest_um) return false;
    chance *= std::min(1.0, digit / std::sqrt(2 * kPi * c.judges.covariance(at, at)));
  }
  return chance < kHardly;
}

}  // namespace abbe::diagnose
