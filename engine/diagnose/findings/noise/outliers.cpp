// noise.outliers: more touches far from where the others predict them than normal noise puts there.
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>

#include "engine/diagnose/findings/noise/noise_property.hpp"
#include "engine/diagnose/findings/on_all_touches.hpp"
#include "engine/diagnose/model/noise_law.hpp"
#include "engine/diagnose/model/prediction.hpp"
#include "engine/effects/noise/noise.hpp"
#include "engine/math/normal.hpp"

namespace abbe::diagnose {

namespace {

/// By how much outliers lie in the mean beyond the limit from which on they are left out: the ends of a pattern that the
/// search has missed are just beyond it.
constexpr double kFarOut = 1.5;

/// So many touches lie beyond the limit of gross outliers by normal noise and, at most but for two standard uncertainties,
/// by what the machine file has of them.
double expected_outliers(const Case& c) {
  const auto in_machine = in_machine_file(c, kOutliers, "share");
  const double share = 2 * normal_below(-kOutlier) + (in_machine ? in_machine->value + 2 * in_machine->u : 0);
  return static_cast<double>(c.masked.size()) * share;
}

/// How far each touch that was left out is from what the others predict, um, once the effects that were found are known:
/// what happened at a moment strikes its first touches alone.
Vector beyond_found(const Case& c, const SearchResult& result) {
  const std::vector<Matrix> found = on_all_touches(c, result.findings);
  if (found.empty()) return c.off_um;
  return beyond_prediction(with_free(compact(c.baseline.model), pointers_to(found)), result.hyper, c.masked);
}

/// Which side they lie on, and what makes touches so.
std::string what_makes(double outwards, double inwards) {
  if (inwards == 0) return ": dirt, burrs or early triggers.";
  if (outwards == 0)
    return ", all too far in: late triggers or pits. Dirt and burrs would be too far out, unless normals point into the part.";
  return fmt::format(
      ", {:.0f} too far out and {:.0f} too far in: a disturbed probe, loose contact or stylus. Dirt and burrs are too far out only.",
      outwards, inwards);
}

/// More touches beyond the limit of gross outliers than normal noise and the machine file put there, and far beyond it.
std::optional<NoiseFinding> judge_outliers(Scatter& s) {
  const Case& c = s.c;
  if (c.off_um.size() == 0) return std::nullopt;
  const Vector beyond = beyond_found(c, s.result);
  std::vector<std::size_t> out;
  double sum = 0, outwards = 0, log_sum = 0, limit = 0;  // `outwards`: how many
  std::map<int, int> by_feature;
  for (std::size_t i = 0; i < c.masked.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double off = beyond(row),
                 own = kOutlier * c.baseline.model.noise_um(row) * c.hyper.noise(c.baseline.model.noise_group[i]);
    if (!c.masked[i] || std::abs(off) < own) continue;
    out.push_back(i);
    ++by_feature[c.touches.touches[i].scene.feature];
    sum += std::abs(off), outwards += off > 0 ? 1 : 0, log_sum += std::log(std::abs(off)), limit += own;
  }
  const auto n = static_cast<double>(out.size());
  const double all = static_cast<double>(c.masked.size()), share = n / all;
  const double p = poisson_tail(n, expected_outliers(c));
  if (n < 2 || p > kNoiseAlarm || sum < kFarOut * limit) return std::nullopt;
  const bool proud = 2 * outwards >= n;
  const double median = (proud ? 1 : -1) * std::exp(log_sum / n), opposite = (proud ? n - outwards : outwards) / n;
  NoiseFinding f{&kOutliers,
                 p,
                 {figure("share", "1", share, std::sqrt(share / all)),
                  figure("size_um", "um", median, kOutlierLogSpread * std::abs(median) / std::sqrt(n))},
                 {}};
  if (opposite > 0) f.parameters.push_back(figure("opposite", "1", opposite, std::sqrt(opposite * (1 - opposite) / n)));
  // Dirt lies anywhere in the sequence. What lies so close together by chance in one recording of twenty may
  // be something that happened then.
  constexpr double kByChance = 0.05;
  f.certain = n * std::pow(double(out.back() + 1 - out.front()) / all, n - 1) > kByChance;
  const auto most = std::max_element(by_feature.begin(), by_feature.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  f.factor = Factor::feature, f.where = {{"feature", c.touches.features[most->first]}};
  f.sentence =
      fmt::format("{:.0f} of {} touches are outliers{}", n, c.masked.size(), what_makes(outwards, n - outwards));
  return f;
}

void plan_outliers(const ScatterDesign& design, Diagnosis& out) {
  const Case& c = design.planned();
  const double touches = double(c.masked.size()), expected = expected_outliers(c);
  double count = std::max(2.0, std::ceil(expected));
  while (count < touches && poisson_tail(count, expected) > kNoiseAlarm) ++count;
  // Of so many in the mean, that many or more are there in kPowerShare of recordings.
  const double mean = least(10 * count, [&](double m) { return poisson_tail(count, m) >= kPowerShare; });
  if (mean > touches) return;
  Detectable d = smallest_of(kOutliers, "share", "1");
  d.detect = mean / touches, d.name = d.detect;
  // Of the usual size, or of that from which on they are far enough out.
  const auto& parameters = kOutliers.parameters;
  const auto size =
      std::find_if(parameters.begin(), parameters.end(), [](const auto& p) { return p.name == "size_um"; });
  d.detect_um = std::max(size->typical, kFarOut * kOutlier * design.noise_um()), d.name_um = d.detect_um;
  out.smallest_detectable.push_back(std::move(d));
}

}  // namespace

const NoiseProperty kJudgedOutliers{&kOutliers, false, judge_outliers, plan_outliers};

}  // namespace abbe::diagnose
