#include "engine/report/run_report.hpp"

#include <algorithm>
#include <map>

#include "engine/report/budget.hpp"
#include "engine/report/report_unit.hpp"

namespace abbe {

namespace {

/// Shares of variance; empty when a contributor's own run left too few values to tell.
std::vector<CharacteristicReport::Contribution> contributions(const std::vector<ContributorRun>& alone,
                                                              const std::vector<Samples>& samples, std::size_t index,
                                                              Unit unit) {
  std::vector<CharacteristicReport::Contribution> list;
  for (const auto& line : variance_budget(alone, samples, index, unit, 1)) list.push_back({line.name, line.share});
  return list;
}

std::optional<double> scaled(std::optional<double> value, double factor) {
  return value ? std::optional(*value * factor) : std::nullopt;
}

/// The values, moved by what the limits of a machine differ from those of the error-free one: each conforms to
/// the common limits just when its own value did to its own.
struct Judged {
  std::vector<double> by_lower, by_upper;
};

Judged against_common_limits(const Samples& samples) {
  const auto apart = [](std::optional<double> own, std::optional<double> common) {
    return common ? own.value_or(0) - *common : 0;  // what is none of a zone or a distance is 0
  };
  Judged judged{samples.value, samples.value};
  for (std::size_t i = 0; i < samples.own_limits.size(); ++i) {
    judged.by_lower[i] -= apart(samples.own_limits[i].lower, samples.limits.lower);
    judged.by_upper[i] -= apart(samples.own_limits[i].upper, samples.limits.upper);
  }
  return judged;
}

CharacteristicReport::CoverageInterval interval_of(const Samples& samples, double factor, double coverage) {
  std::vector<double> values = samples.value;
  for (double& v : values) v *= factor;
  const Summary s = summarize(values, coverage);
  return {coverage, s.symmetric, s.shortest};
}

/// Decides on the value of the error-free machine, in the unit of the report. A zone has no lower limit, but begins
/// at 0.
CharacteristicReport::Decision decision_on(const CharacteristicReport& report, const Judged& judged, double factor) {
  Judged to_errors = judged;
  for (std::vector<double>* errors : {&to_errors.by_lower, &to_errors.by_upper})
    for (double& e : *errors) e = e * factor - *report.reference;
  const JudgedSample errors{to_errors.by_lower, to_errors.by_upper};
  const double upper = *report.upper, begin = report.lower.value_or(0);
  const Interval& interval = report.summary.symmetric;
  CharacteristicReport::Decision d;
  d.verdict = decide(*report.reference, errors, report.lower, upper);
  d.guard_band = guard_band(errors, report.lower, upper);
  if (d.guard_band && upper - *d.guard_band < begin) d.guard_band.reset();
  if (d.guard_band) d.upper = upper - *d.guard_band;
  if (d.guard_band && report.lower) d.lower = *report.lower + *d.guard_band;
  if (upper > begin) d.tolerance_to_uncertainty = (upper - begin) / ((interval.high - interval.low) / 2);
  return d;
}

/// Machines that stopped and have no value here.
int stopped_before(const Samples& samples, const std::vector<Trap>& traps) {
  return static_cast<int>(std::count_if(traps.begin(), traps.end(), [&](const Trap& t) {
    return !std::binary_search(samples.machine.begin(), samples.machine.end(), t.machine);
  }));
}

CharacteristicReport characteristic_report(const plan::Plan& plan, const Samples& samples, const RunResult& run) {
  const plan::CharacteristicDef& definition = plan[samples.characteristic];
  const plan::ToleranceDef& tolerance = plan[definition.tolerance];
  const auto [unit, factor] = report_unit(plan, samples.characteristic);

  CharacteristicReport report;
  for (const plan::FeatureId feature : definition.features) report.features.push_back(plan[feature].label);
  report.tolerance = tolerance.label;
  report.kind = tolerance.kind->word;
  report.unit = unit;
  report.line = definition.line;
  report.characteristic = samples.characteristic;
  report.evaluation = samples.occurrence;
  report.nominal = samples.nominal * factor;
  report.reference = scaled(samples.reference, factor);
  std::vector<double> values = samples.value;
  for (double& v : values) v *= factor;
  report.summary = summarize(values);
  report.varies = report.summary.u >= factor * smallest_u(unit_of(*tolerance.kind, tolerance.arguments));
  report.histogram = histogram(values);
  if (report.reference) {
    report.lcl = report.summary.symmetric.low - *report.reference;
    report.ucl = report.summary.symmetric.high - *report.reference;
  }
  report.lower = scaled(samples.limits.lower, factor);
  report.upper = scaled(samples.limits.upper, factor);
  if (report.varies && (report.lower || report.upper)) {
    const Judged judged = against_common_limits(samples);
    report.conformance_probability =
        conformance_probability({judged.by_lower, judged.by_upper}, samples.limits.lower, samples.limits.upper);
    if (report.upper && report.reference) report.decision = decision_on(report, judged, factor);
  }
  report.evaluated = static_cast<int>(samples.value.size());
  report.trapped = stopped_before(samples, run.traps);
  report.elsewhere = run.machines - report.evaluated - report.trapped;
  return report;
}

}  // namespace

std::vector<int> occurrences(const plan::Plan& plan, const std::vector<Samples>& samples) {
  std::map<plan::EvaluatedAs, int> met;
  std::vector<int> numbers;
  for (const Samples& s : samples) numbers.push_back(++met[plan::evaluated_as(plan, plan[s.characteristic])]);
  return numbers;
}

std::vector<CharacteristicReport> characteristic_reports(const plan::Plan& plan, const RunResult& result,
                                                         const std::vector<ContributorRun>& alone,
                                                         const BudgetRuns* budget, std::optional<double> coverage) {
  std::vector<CharacteristicReport> reports;
  const std::vector<int> numbers = occurrences(plan, result.samples);
  for (std::size_t i = 0; i < result.samples.size(); ++i) {
    const Samples& samples = result.samples[i];
    if (samples.value.size() < 2) continue;
    CharacteristicReport report = characteristic_report(plan, samples, result);
    report.occurrence = numbers[i];
    if (coverage) report.interval = interval_of(samples, report_unit(plan, samples.characteristic).factor, *coverage);
    const plan::ToleranceDef& tolerance = plan[plan[samples.characteristic].tolerance];
    const Unit unit = unit_of(*tolerance.kind, tolerance.arguments);
    report.contributions = contributions(alone, result.samples, i, unit);
    if (budget) {
      const double factor = report_unit(plan, samples.characteristic).factor;
      report.budget = variance_budget(budget->alone, result.samples, i, unit, factor);
      const Samples* alignment = counterpart(result.samples, i, budget->alignment);
      const Samples* feature = counterpart(result.samples, i, budget->feature);
      if (alignment && feature) report.alignment_split = alignment_split(samples, *alignment, *feature, unit, factor);
    }
    reports.push_back(std::move(report));
  }
  return reports;
}

}  // namespace abbe
