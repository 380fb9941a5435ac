#include "engine/diagnose/values/value_diagnosis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "engine/diagnose/baseline/rough_geometry.hpp"
#include "engine/diagnose/explanations/catalogue.hpp"
#include "engine/diagnose/quantile.hpp"
#include "engine/diagnose/values/value_checks.hpp"
#include "engine/diagnose/values/value_naming.hpp"
#include "engine/diagnose/values/value_power.hpp"

namespace abbe {

using namespace diagnose;

namespace {

/// Each value by itself: how far out it is among those of the virtual machines.
std::vector<JudgedValue> judge_each(const ValueCase& c) {
  std::vector<JudgedValue> out;
  for (std::size_t k = 0; k < c.ensemble.values.size(); ++k) {
    const RecordedValue& v = c.ensemble.values[k];
    const ValueRow& row = c.recording->rows[k];
    const auto at = static_cast<Eigen::Index>(k);
    std::vector<double> simulated(c.judges.judged.col(at).begin(), c.judges.judged.col(at).end());
    std::sort(simulated.begin(), simulated.end());
    const double n = double(simulated.size()), distance = std::abs(v.deviation - c.judges.mean(at));
    const auto beyond = std::count_if(simulated.begin(), simulated.end(),
                                      [&](double s) { return std::abs(s - c.judges.mean(at)) >= distance; });
    const double u = std::sqrt(c.judges.covariance(at, at)), unit = v.reported();
    const auto point = [&](double p) { return simulated[static_cast<std::size_t>(p * (n - 1) + 0.5)] * unit; };
    out.push_back({row.characteristic, program_of(c, k), v.angle ? "deg" : "mm", row.run, row.occurrence, row.value,
                   v.reference, v.deviation * unit, u * unit, (v.deviation - c.judges.mean(at)) / u,
                   (double(beyond) + 1) / (n + 1), point(0.025), point(0.975), beyond == 0});
  }
  return out;
}

void tell_references_only(const ValueCase& c, Diagnosis& out) {
  out.judged = Judged::targets_only;
  out.verdict = Verdict::cannot_judge;
  out.messages.push_back(diagnostic(
      Code::W0717, fmt::format("{}: every value is exactly that of an error-free machine", c.recording->source.name()),
      "a real machine differs in the last digits: check that measured values were recorded, and not references"));
  out.otherwise = "Record measured values: those of a real machine differ from their references in the last digits.";
}

/// How often machines look as unusual to the search of a case as the recording does; `machines`: what it says of them.
double p_value_of(const ValueCase& c, const std::vector<double>& machines) {
  return tail_probability(c.search->evidence(c.deviation).statistic, machines);
}

/// The case beside machines in order.
ValueCase specified_case(const ValueRecording& recording, const std::vector<ValueProgram>& programs,
                         const Machine& machine, const DiagnoseOptions& options) {
  std::optional<ValueCase> c = value_case_of(
      recording, programs, machine,
      screened_machines(machine, options.seed, machines_for(recording.rows.size()), options.threads), options);
  if (!c)
    throw UserError(diagnostic(
        Code::E0553, fmt::format("{}: hardly any virtual machine reaches all of these values", recording.source.name()),
        "`abbe run` says where they stop"));
  return std::move(*c);
}

/// Where values stray most: at one characteristic, and in those of its runs that stray at least half as far as the one that does
/// most, unless all do.
Location strongest(const std::vector<JudgedValue>& values) {
  std::map<std::pair<std::string, std::string>, std::vector<const JudgedValue*>> by_characteristic;
  for (const JudgedValue& v : values) by_characteristic[{v.characteristic, v.program}].push_back(&v);
  const auto squares = [](const std::vector<const JudgedValue*>& of) {
    double sum = 0;
    for (const JudgedValue* v : of) sum += v->z * v->z;
    return sum;
  };
  const auto less = [&](const auto& a, const auto& b) { return squares(a.second) < squares(b.second); };
  const auto& [name, mine] = *std::max_element(by_characteristic.begin(), by_characteristic.end(), less);
  double all = 0, most = 0, least_p = 1;
  for (const JudgedValue& v : values) all += v.z * v.z;
  for (const JudgedValue* v : mine) most = std::max(most, std::abs(v->z)), least_p = std::min(least_p, v->p);
  std::vector<const JudgedValue*> stray;
  std::copy_if(mine.begin(), mine.end(), std::back_inserter(stray),
               [&](const JudgedValue* v) { return 2 * std::abs(v->z) >= most; });
  std::set<int> runs;
  for (const JudgedValue* v : stray) runs.insert(v->run);
  Location out{"feature", {{"characteristic", name.first}, {"program", name.second}}};
  if (mine.size() == 1 || stray.size() < mine.size())
    out.where.emplace_back("run", fmt::format("{}", fmt::join(runs, ", ")));
  out.share = squares(stray) / all;
  out.p = std::min(1.0, least_p * double(values.size()));
  return out;
}

/// What sets the recording apart from machines in order.
void tell_mismatch(const ValueCase& c, Diagnosis& out) {
  tell_explanation(c, Closer(c), out);
  const bool between_runs = out.unexplained && out.unexplained->factor == name(Factor::run);
  for (const std::string& slip : {between_runs ? "" : doubt_of_single_repeats(c), doubt_of_micrometres(c)})
    if (!slip.empty()) out.otherwise = slip + (out.otherwise.empty() ? "" : " ") + out.otherwise;
  out.location.push_back(strongest(out.values));
}

}  // namespace

Diagnosis diagnose_values(const ValueRecording& recording, const std::vector<ValueProgram>& programs,
                          const Machine& machine, const DiagnoseOptions& options) {
  begins(options.progress, "virtual machines of the specification, and every effect on them");
  refuse_too_many(recording);
  const ValueCase c = specified_case(recording, programs, machine, options);
  const bool references_only = holds_references_only(c);
  if (!options.design_only && !references_only) refuse_copied_values(c);
  Diagnosis out;
  if (options.design_only) out.judged = Judged::plan;
  doubt_calibrations(c, out.messages);
  doubt_references(c, out.messages);
  out.cannot_judge = cannot_judge(c.search->explanations());
  begins(options.progress, "what these values could detect");
  const std::vector<double> in_order = statistics_of(*c.search, c.judges.judged);
  out.smallest_detectable = smallest_detectable(c, in_order);
  add_hidden(c.search->explanations(), out);
  if (options.design_only) return out;
  out.values = judge_each(c);
  if (references_only) {
    tell_references_only(c, out);
    return out;
  }
  out.p_value = p_value_of(c, in_order);
  if (out.p_value > kAlarm) return out;
  begins(options.progress, "virtual machines with rougher errors");
  const RoughMachines rough =
      rough_machines(machine, options.seed, machines_for(recording.rows.size()), options.threads);
  const std::optional<ValueCase> rougher = value_case_of(recording, programs, rough.machine, rough.machines, options);
  if (rougher)
    out.p_value = std::max(out.p_value, p_value_of(*rougher, statistics_of(*rougher->search, rougher->judges.judged)));
  if (out.p_value > kAlarm) return out;
  begins(options.progress, "sizes of what was found");
  tell_mismatch(c, out);
  return out;
}

}  // namespace abbe
