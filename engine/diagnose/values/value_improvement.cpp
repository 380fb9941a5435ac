#include "engine/diagnose/values/value_improvement.hpp"

#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "engine/diagnose/findings/improvement.hpp"

namespace abbe::diagnose {

namespace {

/// The groups that are left out in turn: programs, else characteristics with all their repeats, which foretell each other
/// whatever made them.
std::vector<int> groups_of(const ValueCase& c, std::string& scheme) {
  std::vector<int> program, characteristic;
  std::map<std::tuple<int, int, int>, int> met;
  for (const RecordedValue& v : c.ensemble.values) {
    program.push_back(v.program);
    characteristic.push_back(
        met.emplace(std::tuple(v.program, v.characteristic.value, v.occurrence), static_cast<int>(met.size()))
            .first->second);
  }
  const bool programs = std::set<int>(program.begin(), program.end()).size() >= 3;
  scheme = programs ? "leave-one-program-out" : "leave-one-characteristic-out";
  return programs ? program : characteristic;
}

}  // namespace

void show_improvement(const ValueCase& c, const Closer& closer, const Finding& f, Diagnosis& out) {
  Improvement i;
  const std::vector<int> group = groups_of(c, i.scheme);
  const auto at = static_cast<std::size_t>(f.explanation);
  const std::vector<int>& variants = closer.explanation(f).variants;
  const double complete = closer.search.evidence(c.deviation).log_bayes[at];
  std::vector<double> gain;
  Vector predicted = Vector::Zero(c.deviation.size());
  for (const int g : std::set<int>(group.begin(), group.end())) {
    std::vector<char> dropped;
    for (const int k : group) dropped.push_back(k == g);
    std::vector<Eigen::Index> kept;
    const ValueSearch search = closer.search.rest(f.explanation, dropped, kept);
    if (kept.empty()) return;
    const Vector rest = c.deviation(kept);
    const Evidence evidence = search.evidence(rest);
    gain.push_back(complete - evidence.log_bayes[0]);
    const int best = best_variant(search.explanations(), 0, evidence);
    const int variant = variants[best];
    const Vector all = closer.search.predicted(variant, sizes_of(search, best, rest).mean);
    for (std::size_t k = 0; k < group.size(); ++k)
      if (group[k] == g) predicted(static_cast<Eigen::Index>(k)) = all(static_cast<Eigen::Index>(k));
  }
  i.log_score_gain = std::accumulate(gain.begin(), gain.end(), 0.0);
  i.se = standard_error_of_sum(gain, group);
  const std::vector<Eigen::Index> told = of_figures(c.ensemble.values);
  const Vector before = (c.deviation - c.judges.mean)(told), after = before - predicted(told);
  const double of_told = double(told.size()), values = double(c.deviation.size());
  i.rms_before_um = std::sqrt(before.squaredNorm() / of_told),
  i.rms_after_um = std::sqrt(after.squaredNorm() / of_told);
  const Vector sense = predicted(told).array().sign();
  i.bias_before_um = before.dot(sense) / of_told, i.bias_after_um = after.dot(sense) / of_told;
  i.chi2_per_dof_before = c.search->white(c.deviation).squaredNorm() / values;
  i.chi2_per_dof_after = c.search->white(c.deviation - predicted).squaredNorm() / values;
  out.improvement = i;
}

}  // namespace abbe::diagnose
