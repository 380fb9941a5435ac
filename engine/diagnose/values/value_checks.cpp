#include "engine/diagnose/values/value_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "engine/diagnose/quantile.hpp"
#include "engine/diagnose/words.hpp"
#include "engine/math/units.hpp"

namespace abbe::diagnose {

namespace {

using Value = std::tuple<int, int, int>;  ///< program, characteristic, occurrence

Value value_of(const RecordedValue& v) { return {v.program, v.characteristic.value, v.occurrence}; }

using RepeatedValues = std::vector<std::pair<Eigen::Index, Eigen::Index>>;  ///< rows of one value in two runs

/// The logarithm of the chance that so many repeats are alike, of the lengths or the angles. They have the steps of the last
/// digit, or larger ones, as those of scales.
double log_chance_of(const ValueCase& c, const RepeatedValues& alike, bool angles) {
  constexpr double kQuieter = 5;  // than the specification says a probe may be, and repeat so much better
  std::vector<double> written;
  for (const auto& [a, b] : alike)
    if (c.ensemble.values[static_cast<std::size_t>(b)].angle == angles)
      written.push_back(c.recording->rows[static_cast<std::size_t>(b)].value);
  double out = 0;
  for (const auto& [a, b] : alike) {
    const RecordedValue& v = c.ensemble.values[static_cast<std::size_t>(b)];
    if (v.angle != angles) continue;
    const Vector apart = c.ensemble.simulated.col(a) - c.ensemble.simulated.col(b);
    const double scatter = std::sqrt((apart.array() - apart.mean()).square().mean()) / kQuieter,
                 digit = std::sqrt(12.0) * c.recorded(b, c.deviation.size() + b),
                 step = std::max(digit, common_step_mm(written) / v.reported());
    if (digit > 0 && scatter > 0) out += std::min(0.0, std::log(step / (std::sqrt(2 * kPi) * scatter)));
  }
  return out;
}

}  // namespace

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

void doubt_references(const ValueCase& c, std::vector<Diagnostic>& messages) {
  // mm or degrees: what lies further apart is another length of the artefact, and what is nearer the same
  constexpr double kOneLength = 0.1, kRounding = 1e-6;
  std::map<std::pair<std::string, std::string>, std::vector<const ValueRow*>> of;
  for (const ValueRow& row : c.recording->rows)
    if (row.reference && !row.artefact.empty())
      of[{row.artefact, abbe::labels_of(row.characteristic).back()}].push_back(&row);
  for (auto& [which, rows] : of) {
    std::stable_sort(rows.begin(), rows.end(),
                     [](const ValueRow* a, const ValueRow* b) { return *a->reference < *b->reference; });
    for (std::size_t k = 1; k < rows.size(); ++k) {
      const ValueRow &a = *rows[k - 1], &b = *rows[k];
      const double apart = *b.reference - *a.reference;
      if (apart <= std::max({a.expanded_uncertainty, b.expanded_uncertainty, kRounding}) || apart >= kOneLength)
        continue;
      messages.push_back(diagnostic_at(
          c.recording->source, b.span, Code::W0739,
          fmt::format("{} of '{}' has the reference {:.9g} here and {:.9g} elsewhere: they lie further apart than U",
                      which.second, which.first, *b.reference, *a.reference),
          "correct them; give each of several such lengths a word of its own under artefact. Are value and reference exchanged?"));
      return;
    }
  }
}

void refuse_copied_values(const ValueCase& c) {
  constexpr double kNearlyAllOfRun = 0.9, kLogHardly = -14;
  std::map<int, std::map<Value, Eigen::Index>> runs;
  for (std::size_t k = 0; k < c.ensemble.values.size(); ++k) {
    const RecordedValue& v = c.ensemble.values[k];
    runs[c.recording->rows[k].run][value_of(v)] = static_cast<Eigen::Index>(k);
  }
  for (auto later = runs.begin(); later != runs.end(); ++later)
    for (auto earlier = runs.begin(); earlier != later; ++earlier) {
      RepeatedValues alike;
      for (const auto& [value, k] : later->second) {
        const auto other = earlier->second.find(value);
        if (other == earlier->second.end()) continue;
        const std::vector<ValueRow>& rows = c.recording->rows;
        if (rows[static_cast<std::size_t>(other->second)].value == rows[static_cast<std::size_t>(k)].value)
          alike.emplace_back(other->second, k);
      }
      const std::size_t smaller = std::min(earlier->second.size(), later->second.size());
      if (double(alike.size()) < kNearlyAllOfRun * double(smaller)) continue;
      if (log_chance_of(c, alike, false) + log_chance_of(c, alike, true) > kLogHardly) continue;
      const auto first = std::min_element(later->second.begin(), later->second.end(),
                                          [](const auto& a, const auto& b) { return a.second < b.second; });
      throw UserError(diagnostic_at(
          c.recording->source, c.recording->rows[static_cast<std::size_t>(first->second)].span, Code::E0713,
          fmt::format("run {} holds the same values as run {}, to their last digit: rows were copied", later->first,
                      earlier->first),
          "keep each run once; a repeat has other values"));
    }
}

std::string doubt_of_micrometres(const ValueCase& c) {
  constexpr double kTimesFurther = 100;
  const std::vector<std::string> labels = labels_of(c);
  std::vector<std::string> doubted;
  for (std::size_t k = 0; k < labels.size(); ++k) {
    const RecordedValue& v = c.ensemble.values[k];
    const auto machines = c.judges.judged.col(static_cast<Eigen::Index>(k));
    const double thousandth = c.recording->rows[k].value - v.reference / v.reported();  // deviation, um
    if (v.angle || std::abs(v.deviation) < kTimesFurther * machines.cwiseAbs().maxCoeff()) continue;
    if (thousandth < machines.minCoeff() || thousandth > machines.maxCoeff()) continue;
    if (std::find(doubted.begin(), doubted.end(), labels[k]) == doubted.end()) doubted.push_back(labels[k]);
  }
  if (doubted.empty()) return "";
  return fmt::format("Check the unit of {}: in micrometres it would be what a machine of the specification measures.",
                     fmt::join(doubted, " and of "));
}

std::vector<FarRepeat> far_from_repeats(const ValueCase& c) {
  constexpr std::size_t kLeastRepeats = 3;
  constexpr double kFar = 8, kOfTheOthers = 5,
                   kDigits = 3;  // what a repeat scatters, the range of the others, last digits
  std::map<Value, std::vector<Eigen::Index>> repeats;
  for (std::size_t k = 0; k < c.ensemble.values.size(); ++k)
    repeats[value_of(c.ensemble.values[k])].push_back(static_cast<Eigen::Index>(k));
  std::vector<FarRepeat> out;
  for (const auto& [value, rows] : repeats) {
    if (rows.size() < kLeastRepeats) continue;
    const Vector apart = c.ensemble.simulated.col(rows[0]) - c.ensemble.simulated.col(rows[1]);
    const double scatter = std::sqrt((apart.array() - apart.mean()).square().mean() / 2);
    for (const Eigen::Index k : rows) {
      std::vector<double> others;
      for (const Eigen::Index other : rows)
        if (other != k) others.push_back(c.deviation(other));
      const auto [least, most] = std::minmax_element(others.begin(), others.end());
      const double range = *most - *least, beside = c.deviation(k) - median(others);
      const auto at = static_cast<std::size_t>(k);
      const double digit = c.recording->rows[at].last_digit / c.ensemble.values[at].reported();
      if (std::abs(beside) >= std::max({kFar * scatter, kOfTheOthers * range, kDigits * digit}))
        out.push_back({at, beside});
    }
  }
  return out;
}

std::string doubt_of_single_repeats(const ValueCase& c) {
  const std::vector<std::string> labels = labels_of(c);
  std::vector<std::string> doubted;
  for (const auto& [value, beside] : far_from_repeats(c))
    doubted.push_back(fmt::format("{} in run {} is {} {} beside its other runs", labels[value],
                                  c.recording->rows[value].run, two_digits(std::abs(beside)),
                                  c.ensemble.values[value].angle ? "urad" : "um"));
  if (doubted.empty()) return "";
  return fmt::format("{}, which agree: check what was written there, and measure it again.",
                     fmt::join(doubted, ", and "));
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
