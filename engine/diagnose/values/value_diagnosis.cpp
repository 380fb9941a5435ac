#include "engine/diagnose/values/value_diagnosis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "engine/diagnose/case.hpp"
#include "engine/diagnose/explanations/catalogue.hpp"
#include "engine/diagnose/findings/belief.hpp"
#include "engine/diagnose/findings/carried.hpp"
#include "engine/diagnose/findings/improvement.hpp"
#include "engine/diagnose/findings/locate.hpp"
#include "engine/diagnose/findings/members.hpp"
#include "engine/diagnose/findings/search.hpp"
#include "engine/diagnose/quantile.hpp"
#include "engine/diagnose/values/value_estimate.hpp"
#include "engine/diagnose/values/value_power.hpp"
#include "engine/diagnose/values/value_search.hpp"
#include "engine/diagnose/values/value_signature.hpp"
#include "engine/diagnose/words.hpp"
#include "engine/math/normal.hpp"
#include "engine/run/recorded/logged.hpp"

namespace abbe {

using namespace diagnose;

namespace {

constexpr int kHalf = 1000, kPerValue = 10, kMostValues = 500;

/// Simulated machines that values are compared with.
struct Judges {
  Vector mean;        ///< of the first half
  Matrix covariance;  ///< of these, with that of the calibrations
  Matrix judged;      ///< the second half, with errors of calibration
};

/// Recorded values, and what they are judged by.
struct ValueCase {
  const ValueRecording* recording = nullptr;
  const std::vector<ValueProgram>* programs = nullptr;
  const Machine* machine = nullptr;
  const DiagnoseOptions* options = nullptr;
  ValueEnsemble ensemble;
  Vector deviation;
  Matrix calibration;  ///< one column for each artefact: a standard deviation of its calibration
  Judges judges;
  std::optional<ValueSearch> search;
};

/// `simulated`: machines x values, more than twice as many machines as values.
Judges judges_of(const Matrix& simulated, const Matrix& calibration, std::uint64_t seed) {
  const Eigen::Index half = simulated.rows() / 2;
  Judges out;
  out.judged = with_calibration(simulated.bottomRows(simulated.rows() - half), calibration, seed);
  out.mean = simulated.topRows(half).colwise().mean();
  const Matrix centred = simulated.topRows(half).rowwise() - out.mean.transpose();
  out.covariance = centred.transpose() * centred / double(half - 1) + calibration * calibration.transpose();
  out.covariance.diagonal().array() += kLeastOfValue_um * kLeastOfValue_um;
  return out;
}

ValueReference reference_of(const ValueCase& c) {
  return {c.ensemble.values, *c.programs, *c.machine, *c.options, c.deviation, c.judges.covariance, c.calibration};
}

/// As the recording calls the program of a value, else the name of its file.
std::string program_of(const ValueCase& c, std::size_t value) {
  const std::string& said = c.recording->rows[value].program;
  const SourceFile& source = *(*c.programs)[c.ensemble.values[value].program].source;
  return said.empty() ? std::filesystem::path(source.name()).filename().string() : said;
}

/// "LX2 of part.dmi"; the evaluation too, where it is not the first.
std::vector<std::string> labels_of(const ValueCase& c) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < c.ensemble.values.size(); ++k) {
    const RecordedValue& v = c.ensemble.values[k];
    out.push_back(fmt::format("{} of {}", c.recording->rows[k].characteristic, program_of(c, k)));
    if (v.occurrence > 1) out.back() += fmt::format(", evaluation {}", v.occurrence);
  }
  return out;
}

/// How many virtual machines judge so many values.
int machines_for(Eigen::Index values) { return 2 * (kHalf + kPerValue * static_cast<int>(values)); }
bool enough(const Matrix& simulated) { return simulated.rows() / 2 >= simulated.cols() + 2; }

ValueCase value_case_of(const ValueRecording& recording, const std::vector<ValueProgram>& programs,
                        const Machine& machine, const DiagnoseOptions& options) {
  const int n = static_cast<int>(recording.rows.size());
  if (n > kMostValues)
    throw UserError(diagnostic(Code::E0552, fmt::format("{}: {} values are too many", recording.source.name(), n),
                               fmt::format("at most {} are judged together; split the file", kMostValues)));
  ValueCase c;
  c.recording = &recording, c.programs = &programs, c.machine = &machine, c.options = &options;
  c.ensemble = value_ensemble(recording, programs, machine, options, machines_for(n));
  c.deviation.resize(n), c.calibration.setZero(n, n);
  for (int k = 0; k < n; ++k) {
    const RecordedValue& v = c.ensemble.values[k];
    c.deviation(k) = v.deviation, c.calibration(k, v.artefact) = v.calibration;
  }
  if (!enough(c.ensemble.simulated))
    throw UserError(diagnostic(
        Code::E0553, fmt::format("{}: hardly any virtual machine reaches all of these values", recording.source.name()),
        "`abbe run` says where they stop"));
  c.judges = judges_of(c.ensemble.simulated, c.calibration, options.seed);
  add_value_patterns(labels_of(c), c.judges.covariance, c.ensemble.explanations);
  c.search.emplace(c.judges.mean, c.judges.covariance, c.ensemble.explanations);
  return c;
}

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

/// The search once more, beside the errors that a machine has.
struct Closer {
  ValueSearch search;
  std::map<int, Sizes> sizes;  ///< by variant, of the likeliest

  explicit Closer(const ValueCase& c) : search(*c.search), sizes(linearise_likeliest(search, reference_of(c))) {}
  const Variant& variant(const Finding& f) const { return search.explanations().variants[f.variant]; }
  const Explanation& explanation(const Finding& f) const { return search.explanations().list[f.explanation]; }
};

std::vector<DiagnosedParameter> parameters_of(const ValueCase& c, const Closer& closer, const Finding& f) {
  const Variant& b = closer.variant(f);
  const Effect& effect = *closer.explanation(f).effect;
  const auto found = closer.sizes.find(f.variant);
  const Sizes s = found != closer.sizes.end() ? found->second : sizes_of(closer.search, f.variant, c.deviation);
  std::vector<DiagnosedParameter> out;
  for (std::size_t k = 0; k < b.columns.size(); ++k) {
    const EffectParameter& p = effect.parameters[b.columns[k].parameter];
    const auto at = static_cast<Eigen::Index>(k);
    const double value = s.mean(at) * b.columns[k].unit, u = std::sqrt(s.covariance(at, at)) * b.columns[k].unit;
    const double low = value - kNormal95 * u, high = value + kNormal95 * u;
    out.push_back({std::string(p.name), std::string(p.unit), value, u, low, high, {}, high >= p.low && low <= p.high});
  }
  for (std::size_t p = 0; p < effect.parameters.size(); ++p) {
    const EffectParameter& parameter = effect.parameters[p];
    if (parameter.choices.empty()) continue;
    DiagnosedParameter choice{.name = std::string(parameter.name), .unit = ""};
    choice.word = parameter.choices[std::lround(b.theta[p] - parameter.low)];
    out.push_back(std::move(choice));
  }
  return out;
}

void tell_pattern(const ValueCase& c, const Closer& closer, const Finding& f, Diagnosis& out) {
  const Explanation& e = closer.explanation(f);
  const Vector sizes = sizes_of(closer.search, f.variant, c.deviation).mean, all = closer.variant(f).signature * sizes,
               pattern = all(of_figures(c.ensemble.values));
  // located in the values themselves: no more is known of them
  out.unexplained = pattern_of_size(Factor::feature, e.shape, std::sqrt(pattern.squaredNorm() / double(pattern.size())),
                                    closer.search.information(f.variant, c.deviation).u.dot(sizes));
  out.verdict = Verdict::unexplained;
  if (e.shape == kOneCharacteristic) {
    const std::string& which = closer.variant(f).told;
    Eigen::Index at = 0;
    const double most = all.cwiseAbs().maxCoeff(&at);
    out.unexplained->sentence = fmt::format(
        "No effect of the catalogue explains it: {} strays by itself, by {} {}, and what the other values say of the machine does not explain it.",
        which, two_digits(most), c.ensemble.values[static_cast<std::size_t>(at)].angle ? "urad" : "um");
    out.otherwise = fmt::format("Check reference, U and program of {}, and measure it again.", which);
    return;
  }
  out.unexplained->sentence = e.shape == "single values"
      ? "No effect of the catalogue explains it: single values stray (the table says which)."
      : "No effect of the catalogue explains it: the values deviate as those of a machine with larger errors than specified.";
  out.otherwise =
      "Values hold too little to tell an effect on all lengths from a machine out of its specification: measure calibrated lengths along each axis, or give the touches themselves, with x, y, z of each.";
}

/// The members of a set, the first as it was told, some others with sizes of their own.
std::vector<DiagnosedMember> members_of(const ValueCase& c, const Closer& closer, const Finding& f,
                                        const DiagnosedEffect& told) {
  std::vector<DiagnosedMember> out;
  for (const int k : f.set) {
    out.push_back({told.probability * share_of(closer.search.explanations(), f, k), {}, {}});
    Finding alone = f;
    alone.explanation = k, alone.variant = f.variant_of(k);
    if (out.size() <= kSized)
      out.back().parameters = k == f.explanation ? told.parameters : parameters_of(c, closer, alone);
  }
  return out;
}

/// What would tell the members of a set apart, where values do not.
std::string to_tell_apart(const Explanations& all, const Finding& f) {
  std::string out = "These values do not tell them apart. What would:";
  for (std::size_t k = 0; k < std::min(f.set.size(), kSized); ++k) {
    const Explanation& e = all.list[f.set[k]];
    out += fmt::format(" {}: {}.", e.name, e.effect->separate);
  }
  return out;
}

void tell_name(const ValueCase& c, const Closer& closer, const Finding& f, double adequacy, Diagnosis& out) {
  const Explanations& all = closer.search.explanations();
  DiagnosedEffect e;
  std::vector<std::string_view> titles;
  for (const int k : f.set) {
    e.members.push_back(all.list[k].name);
    titles.push_back(all.list[k].effect->title);
  }
  const Effect& effect = *closer.explanation(f).effect;
  e.parameters = parameters_of(c, closer, f);
  const unsigned untold = std::accumulate(f.set.begin(), f.set.end(), 0u,
                                          [&](unsigned missing, int k) { return missing | all.list[k].missing; });
  const bool only_untold = closer.explanation(f).missing != 0;
  const std::string in_file =
      belief_in_first(all, f) < kCarried ? kNotCarried : carry(*c.machine, effect, e.parameters, out);
  e.probability = believed(f.probability, adequacy < kInadequate || !all_plausible(e.parameters) || only_untold);
  e.sentence = explanation_sentence(titles, e.parameters, "a file of values", {}, e.probability < kTold);
  if (untold != 0) {
    const std::string columns = fmt::format("{}", fmt::join(columns_of(untold), ", "));
    e.sentence += fmt::format(" Whether it is that depends on {}: a workpiece file tells them (--workpiece).", columns);
    out.otherwise =
        fmt::format("Tell {} in a workpiece file, and diagnose the same values with it (--workpiece).", columns);
  }
  if (f.set.size() > 1) {
    e.by_member = members_of(c, closer, f, e);
    out.otherwise += (out.otherwise.empty() ? "" : " ") + to_tell_apart(all, f);
  }
  e.sentence += in_file;
  out.adequacy_p = adequacy;
  out.verdict = f.set.size() > 1 ? Verdict::one_of : Verdict::named;
  out.effects.push_back(std::move(e));
}

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

/// What the explanation predicts of values that it was not fitted to (improvement.cpp has the formula). The point near
/// which a variant is linear is that of all values.
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

/// How often such machines look as unusual to a search as the recording does.
double chance_of(const ValueCase& c, const ValueSearch& search, const Matrix& machines) {
  return tail_probability(search.evidence(c.deviation).statistic, statistics_of(search, machines));
}

/// How often chance leaves as much as a pattern does, or a name that no machine was simulated with.
double left_by_chance(const ValueCase& c, const Closer& closer, const Finding& f) {
  const ValueSearch without(c.judges.mean, c.judges.covariance, c.search->explanations(), closer.variant(f).signature);
  return chance_of(c, without, c.judges.judged);
}

/// How often a machine with the effect that is named leaves as much as the recording does.
double adequacy_of(const ValueCase& c, const Closer& closer, const Finding& name) {
  if (name.explanation < 0) return 1;
  const auto found = closer.sizes.find(name.variant);
  if (found == closer.sizes.end()) return left_by_chance(c, closer, name);
  const Variant& variant = closer.variant(name);
  const Machine planted = with_effect(*c.machine, *closer.explanation(name).effect, variant, found->second.mean);
  const VirtualMachines machines =
      screened_machines(*c.machine, c.options->seed, machines_for(c.deviation.size()), c.options->threads);
  const Matrix simulated =
      complete_rows(simulated_values(c.ensemble.values, *c.programs, planted, machines, *c.options));
  if (!enough(simulated)) return left_by_chance(c, closer, name);
  const Judges judges = judges_of(simulated, c.calibration, c.options->seed);
  return chance_of(c, ValueSearch(judges.mean, judges.covariance, c.search->explanations(), variant.signature),
                   judges.judged);
}

/// Of a set those first that need nothing untold.
void put_told_first(const Explanations& all, const Evidence& evidence, Finding& name) {
  if (name.set.empty()) return;
  std::stable_partition(name.set.begin(), name.set.end(), [&](int k) { return !all.list[k].missing; });
  if (name.set.front() == name.explanation) return;
  name.explanation = name.set.front();
  name.variant = best_variant(all, name.explanation, evidence);
}

struct NameAndPattern {
  Finding name, pattern;
};

/// The likeliest name with a size that it can have, if one is likelier than a pattern; else the likeliest. Beside it the
/// likeliest pattern, once those names are struck that are impossible.
NameAndPattern possible_name(const ValueCase& c, const Closer& closer, const Evidence& evidence) {
  constexpr int kMost = 5;
  constexpr double kStruck = -1e6;
  const Explanations& all = closer.search.explanations();
  Evidence left = evidence;
  std::optional<NameAndPattern> likeliest;
  for (int k = 0; k < kMost; ++k) {
    NameAndPattern now{finding_of(all, left, true), finding_of(all, left, false)};
    put_told_first(all, left, now.name);
    if (!likeliest) likeliest = now;
    if (!likelier(now.name, now.pattern, kNamed)) break;
    if (all_plausible(parameters_of(c, closer, now.name))) return now;
    left.log_bayes[now.name.explanation] = kStruck;
  }
  return *likeliest;
}

/// The characteristic that strays by itself, where chance leaves as much as the others do.
std::optional<Finding> one_characteristic(const ValueCase& c, const Closer& closer, const Evidence& evidence) {
  const Explanations& all = closer.search.explanations();
  const auto found = std::find_if(all.list.begin(), all.list.end(),
                                  [](const Explanation& e) { return e.shape == kOneCharacteristic; });
  if (found == all.list.end()) return std::nullopt;
  Finding f;
  f.explanation = static_cast<int>(found - all.list.begin());
  f.variant = best_variant(all, f.explanation, evidence);
  f.set = {f.explanation};
  return left_by_chance(c, closer, f) >= kInadequate ? std::optional(f) : std::nullopt;
}

/// A name, or what stands for none; what is told is returned.
Finding tell(const ValueCase& c, const Closer& closer, Diagnosis& out) {
  const Evidence evidence = closer.search.evidence(c.deviation);
  auto [name, pattern] = possible_name(c, closer, evidence);
  const double adequacy = adequacy_of(c, closer, name);
  const bool doubted = adequacy < kInadequate && leaves_less(left_by_chance(c, closer, pattern), adequacy);
  const bool named = likelier(name, pattern, doubted ? kNamedInDoubt : kNamed);
  if (!named) pattern = one_characteristic(c, closer, evidence).value_or(pattern);
  if (named)
    tell_name(c, closer, name, adequacy, out);
  else
    tell_pattern(c, closer, pattern, out);
  if (!named && name.explanation >= 0 && closer.explanation(pattern).shape != kOneCharacteristic)
    out.unexplained->sentence +=
        fmt::format(" Of the catalogue, {} comes nearest.", closer.explanation(name).effect->title);
  return named ? name : pattern;
}

/// What no possible size makes seen cannot be judged.
void tell_hidden(const ValueSearch& search, Diagnosis& out) {
  for (const Explanation& e : search.explanations().list)
    if (e.effect && !e.missing && !tells_of(out, e.name)) out.cannot_judge.push_back({e.name, {}, {}});
}

/// Calibrations that say less of most values than any machine of the specification would.
void doubt_calibrations(const ValueCase& c, std::vector<Diagnostic>& messages) {
  constexpr double kTimes = 3;
  std::vector<double> times;
  for (Eigen::Index k = 0; k < c.deviation.size(); ++k) {
    const double calibrated = c.calibration.row(k).norm(), of_both = std::sqrt(c.judges.covariance(k, k));
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

/// Whether every value is, to its last digit, what it should be. Machines of the specification would not report that: the
/// chance is the digit times the density of the values.
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

void tell_references_only(const ValueCase& c, Diagnosis& out) {
  out.judged = Judged::targets_only;
  out.verdict = Verdict::cannot_judge;
  out.messages.push_back(diagnostic(
      Code::W0717, fmt::format("{}: every value is exactly that of an error-free machine", c.recording->source.name()),
      "a real machine differs in the last digits: check that measured values were recorded, and not references"));
  out.otherwise = "Record measured values: those of a real machine differ from their references in the last digits.";
}

}  // namespace

Diagnosis diagnose_values(const ValueRecording& recording, const std::vector<ValueProgram>& programs,
                          const Machine& machine, const DiagnoseOptions& options) {
  begins(options.progress, "virtual machines of the specification, and every effect on them");
  const ValueCase c = value_case_of(recording, programs, machine, options);
  Diagnosis out;
  if (options.design_only) out.judged = Judged::plan;
  doubt_calibrations(c, out.messages);
  out.cannot_judge = cannot_judge(c.search->explanations());
  begins(options.progress, "what these values could detect");
  const std::vector<double> in_order = statistics_of(*c.search, c.judges.judged);
  out.smallest_detectable = smallest_detectable(*c.search, reference_of(c), in_order);
  tell_hidden(*c.search, out);
  if (options.design_only) return out;
  out.values = judge_each(c);
  if (holds_references_only(c)) {
    tell_references_only(c, out);
    return out;
  }
  out.p_value = tail_probability(c.search->evidence(c.deviation).statistic, in_order);
  if (out.p_value > kAlarm) return out;
  begins(options.progress, "sizes of what was found");
  const Closer closer(c);
  show_improvement(c, closer, tell(c, closer, out), out);
  const auto worst =
      std::max_element(out.values.begin(), out.values.end(),
                       [](const JudgedValue& a, const JudgedValue& b) { return std::abs(a.z) < std::abs(b.z); });
  double squares = 0;
  for (const JudgedValue& v : out.values) squares += v.z * v.z;
  out.location.push_back(
      {"feature",
       {{"characteristic", worst->characteristic}, {"program", worst->program}, {"run", std::to_string(worst->run)}},
       worst->z * worst->z / squares,
       std::min(1.0, worst->p * double(out.values.size()))});
  return out;
}

}  // namespace abbe
