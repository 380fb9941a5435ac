#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "engine/diagnose/baseline/known_state.hpp"
#include "engine/diagnose/baseline/length_errors.hpp"
#include "engine/diagnose/baseline/outliers.hpp"
#include "engine/diagnose/baseline/own_noise.hpp"
#include "engine/diagnose/baseline/standing.hpp"
#include "engine/diagnose/case.hpp"
#include "engine/diagnose/checks/clock.hpp"
#include "engine/diagnose/checks/data_problems.hpp"
#include "engine/diagnose/checks/logged_columns.hpp"
#include "engine/diagnose/checks/normals.hpp"
#include "engine/diagnose/checks/pairing.hpp"
#include "engine/diagnose/checks/repeats.hpp"
#include "engine/diagnose/checks/scale_readings.hpp"
#include "engine/diagnose/explanations/catalogue.hpp"
#include "engine/diagnose/findings/belief.hpp"
#include "engine/diagnose/findings/improvement.hpp"
#include "engine/diagnose/findings/locate.hpp"
#include "engine/diagnose/findings/members.hpp"
#include "engine/diagnose/findings/noise/judge_noise.hpp"
#include "engine/diagnose/findings/on_all_touches.hpp"
#include "engine/diagnose/findings/other_methods.hpp"
#include "engine/diagnose/findings/tell.hpp"
#include "engine/diagnose/model/restricted_likelihood.hpp"
#include "engine/diagnose/planning/advice.hpp"
#include "engine/diagnose/planning/design.hpp"
#include "engine/diagnose/planning/next_measurement.hpp"
#include "engine/diagnose/planning/noise_design.hpp"
#include "engine/diagnose/quantile.hpp"
#include "engine/diagnose/warnings.hpp"
#include "engine/machine/screening.hpp"

namespace abbe {

using namespace diagnose;

namespace {

/// What the file says of the surfaces.
std::optional<Surfaces> stated_surfaces(const Recording& r) {
  const std::optional<std::string> word = said(r.metadata, "surfaces");
  return word ? find_surfaces(*word) : std::nullopt;  // the reader refuses another one
}

/// Beyond this, what all touches are too far out is no effect but a wrong tip, unless sizes are unknown or
/// given elsewhere.
double most_out_mm(const Recording& r, const Machine& machine, const DiagnoseOptions& options) {
  constexpr double kBeyondPretravel_mm = 0.05, kBeyondSizes_mm = 0.25;
  const bool unknown = said(r.metadata, "surfaces").value_or("").starts_with("unknown");
  return unknown || options.workpiece || !machine.effects.empty() ? kBeyondSizes_mm : kBeyondPretravel_mm;
}

/// Whether the file holds targets in the place of positions.
bool holds_targets_only(const Recording& r) {
  return std::all_of(r.rows.begin(), r.rows.end(),
                     [](const RecordingRow& row) { return row.target_mm && row.position_mm == *row.target_mm; });
}

/// The recording without what its file does wrong, with every part on its targets.
Recording ready(const Recording& recorded, const Machine& machine, const DiagnoseOptions& options,
                const std::string& file, std::vector<Diagnostic>& messages) {
  Recording numbered = recorded;
  number_repeats(numbered, file, messages);
  Recording once = without_copies(numbered, file, messages);
  check_data(once, machine, file);
  leave_out_targets(once, file, messages);
  doubt_temperatures(once, file, messages);
  doubt_motion(once, file, messages);
  leave_out_clock_at_rest(once, file, messages);
  leave_out_partly_logged(once, file, messages);
  leave_out_head_at_rest(once, machine, file, messages);
  leave_out_constant_travel(once, file, messages);
  leave_out_readings_without_phase(once, file, messages);
  leave_out_commanded_readings(once, file, messages);
  continue_past_midnight(once, file, messages);
  continue_where_put_back(once, file, messages);
  continue_from_run_to_run(once, file, messages);
  doubt_fall(once, file, messages);
  doubt_run_numbers(once, file, messages);
  count_from_first_touch(once, file, messages);
  Recording placed = put_on_targets(once, most_out_mm(once, machine, options), file, messages);
  leave_out_astray(placed, file, messages);
  return placed;
}

/// A plan may be a recording of old, with the clock of the day and with positions, of which none is looked at.
Recording planned(Recording recorded, const std::string& file, std::vector<Diagnostic>& messages) {
  for (RecordingRow& row : recorded.rows)
    if (row.target_mm) row.position_mm = *row.target_mm;
  if (!recorded.in_part_frame) read_at_targets(recorded);
  leave_out_clock_at_rest(recorded, file, messages);
  doubt_run_numbers(recorded, file, messages);
  count_from_first_touch(recorded, file, messages);
  return recorded;
}

void refuse_too_many(const Recording& r, const std::string& file) {
  constexpr std::size_t kMostTouches = 4000;  // ten minutes, and 5 GB (docs/benchmarks.md)
  if (r.rows.size() > kMostTouches)
    throw UserError(diagnostic(
        Code::E0719, fmt::format("{}: {} touches are too many to be judged together", file, r.rows.size()),
        fmt::format("at most {}: leave out repeats, or diagnose a part of the runs at a time", kMostTouches)));
}

BaselineSummary summary(const Case& c, const Hyperparameters& hyper, bool known) {
  BaselineSummary b;
  b.known = known;
  b.geometry_scale = hyper.scale;
  b.correlation = hyper.correlation;
  Vector square = Vector::Zero(hyper.noise.size()), rows = square;
  for (Eigen::Index i = 0; i < c.model.y.size(); ++i) {
    const int g = c.model.noise_group[i];
    square(g) += std::pow(c.model.noise_um(i) * hyper.noise(g), 2);
    ++rows(g);
  }
  b.noise_um = std::sqrt(square.sum() / rows.sum());
  b.stated_noise_um = std::sqrt(c.model.noise_um.squaredNorm() / rows.sum());
  for (std::size_t g = 0; g < c.baseline.noise_names.size(); ++g) {
    const auto k = static_cast<Eigen::Index>(g);
    if (!c.baseline.noise_names[g].empty() && rows(k) > 0)
      b.noise_by_sensor.emplace_back(c.baseline.noise_names[g], std::sqrt(square(k) / rows(k)));
  }
  for (std::size_t i = 0; i < c.masked.size(); ++i) {
    if (!c.masked[i]) continue;
    const RecordingRow& row = c.recording->rows[c.touches.touches[i].row];
    b.outliers.push_back(fmt::format("{} touch {} (setup {}, run {})", row.feature, row.touch, row.setup, row.run));
  }
  return b;
}

/// The geometry of this machine beside what was found: findings are free, so that no error function takes them over.
std::string known_state_beside(const Case& c, const SearchResult& result) {
  Baseline beside = c.baseline;
  std::vector<char> left_out(c.masked.size(), 1);
  for (const int row : c.rows) left_out[row] = 0;
  beside.model = with_free(without_rows(c.baseline.model, left_out), signatures_of(c, result));
  const Hyperparameters hyper = c.rough ? estimate(rougher(beside.model)) : result.hyper;
  return write_known_state(posterior(beside, hyper, c.rough ? Errors::rough : Errors::harmonic), hyper);
}

/// The unknowns of the recording explain whatever it holds: no effect of any size would show.
void tell_nothing_judged(const Case& c, const std::string& file, Diagnosis& out) {
  const bool surfaces = c.baseline.surfaces == Surfaces::unknown;
  const std::string why = surfaces ? "every surface point is unknown, and none was touched in two ways"
                                   : "the unknown placements of the part take up all that the touches tell";
  out.otherwise = surfaces
      ? "Touch the same points again in another run or setup, or give measured or calibrated targets and say '# surfaces: calibrated'."
      : "Touch more points in each setup, on surfaces that face several ways, or give one setup to touches of one placement.";
  out.messages.push_back(
      diagnostic(Code::W0710, fmt::format("{}: nothing can be judged: {}", file, why), out.otherwise));
  out.judged = Judged::hidden_by_unknowns;
  out.verdict = Verdict::cannot_judge;
}

/// Each stylus in each orientation has an offset of its own, and here nobody knows which touches share one: what was found,
/// or errors that seem large, may be that. Until it is known, it is no mismatch of the machine.
Diagnosis without_styli(Diagnosis found, std::vector<Diagnostic> of_the_file) {
  Diagnosis out;
  out.judged = Judged::styli_unlogged;
  out.verdict = Verdict::cannot_judge;
  out.touches = found.touches;
  out.baseline = std::move(found.baseline);
  out.messages = std::move(of_the_file);
  for (const Effect* effect : effects()) {
    const auto same = [&](const CannotJudge& c) { return c.effect == effect->name; };
    const auto known = std::find_if(found.cannot_judge.begin(), found.cannot_judge.end(), same);
    CannotJudge missing = known == found.cannot_judge.end() ? CannotJudge{std::string(effect->name)} : *known;
    for (const char* column : {"head_A_deg", "head_B_deg", "sensor"})
      if (std::find(missing.missing.begin(), missing.missing.end(), column) == missing.missing.end())
        missing.missing.emplace_back(column);
    out.cannot_judge.push_back(std::move(missing));
  }
  out.otherwise =
      "Log sensor, head_A_deg and head_B_deg at each touch, or diagnose the touches of each orientation by themselves.";
  return out;
}

/// A placement is found where most touches lie well: the faces of a part may, and its bores not. Whether
/// those are an effect of the catalogue or another part than the targets say shows when all that can be found
/// has been: what is then left is no machine's.
bool another_part(const Case& c, const SearchResult& result, const Diagnosis& d) {
  constexpr double kMostDirt = 0.1, kMostNoise_um = 10;
  if (c.options.workpiece || within_mm(c.touches, kNineTenths) < kBeyondMachines_mm) return false;
  const auto dirt = double(std::count(c.masked.begin(), c.masked.end(), 1));
  return result.other || dirt > kMostDirt * double(c.masked.size()) || d.baseline.noise_um > kMostNoise_um ||
      std::any_of(d.effects.begin(), d.effects.end(),
                  [](const DiagnosedEffect& e) { return !all_plausible(e.parameters); });
}

/// What is diagnosed.
struct Given {
  const Recording& recording;
  double step_um;  ///< of which the positions were multiples as they were read
  const Machine& machine;
  const DiagnoseOptions& options;
  const std::string& file;
};

/// The part is another one than the targets say.
struct AnotherPart {
  Diagnostic told;
};

/// A plan has no values: all touches take part, where they should be, at the noise that was stated.
void take_plan(Case& c) {
  c.masked.assign(c.touches.touches.size(), 0);
  take_part(c, compact(c.baseline.model));
  c.model.y.setZero();
  c.hyper.noise = Vector::Ones(c.model.noise_groups);
}

/// The search for all explanations. Those of scale readings come last: whether the readings hold noise of their own shows
/// beside the others.
EvidenceSearch search_of(Case& c, bool plan, double reading_step_um) {
  c.explanations = explanations_without_readings(c.touches, c.rows);
  EvidenceSearch search(c.model, c.hyper, c.explanations);
  const std::size_t without_readings = c.explanations.variants.size();
  if (!plan) free_readings_of_noise(c, search);
  add_explanations_of_readings(c.touches, c.rows, std::max(c.step_um, reading_step_um), c.explanations);
  search.extend(c.explanations, without_readings);
  return search;
}

/// What every effect would have to be to show.
void tell_power(const Case& c, const EvidenceSearch& search, Diagnosis& out) {
  out.cannot_judge = cannot_judge(c.explanations);
  out.smallest_detectable = smallest_detectable(c, search);
  add_hidden(c.explanations, out);
  if (!out.smallest_detectable.empty()) add_smallest_scatter(c, out);
}

/// What of the machine itself is not as its file says: lengths, sizes of errors, scatter.
void tell_machine(const Case& c, const SearchResult& result, const std::string& file, Diagnosis& out) {
  const bool known = out.baseline.known;
  const bool named = !result.findings.empty();
  if (const auto beyond = out.beyond ? beyond_beside_names(c, result) : std::nullopt)
    out.messages.push_back(beyond_its_specification(*beyond, named, file));
  const bool only_noise = result.findings.empty() && !result.other;
  if (!known && only_noise && !out.beyond && out.baseline.geometry_scale >= kLargeErrors)
    out.messages.push_back(large_errors(out.baseline.geometry_scale, deviations(c.model, out.baseline.noise_um), file));
  const bool of_noise = std::any_of(out.effects.begin(), out.effects.end(),
                                    [](const DiagnosedEffect& e) { return is_noise(e.members.front()); });
  out.baseline.noisier = !of_noise && scatters_more(out.baseline, static_cast<int>(c.rows.size()));
  if (out.baseline.noisier) out.messages.push_back(more_scatter(out.baseline, file));
  if (known && result.hyper.scale > kAnotherMachine) out.beyond_known = result.hyper.scale;
  if (out.beyond_known) out.messages.push_back(another_machine(*out.beyond_known, file));
}

/// The machine beside what was found, as one of those that the recording fits better: rougher ones, or such with an uneven
/// error function.
BaselineSummary machine_beside(const Case& c, const EvidenceSearch& first, const SearchResult& result, bool known) {
  const bool nothing = result.findings.empty() && !result.other;
  const std::optional<Matrix> uneven = nothing ? first.uneven() : std::nullopt;
  LinearModel m = with_free(likelier_ensemble(c, c.model), signatures_of(c, result));
  if (uneven) m = with_random(m, *uneven);
  BaselineSummary out = summary(c, uneven ? estimate(m) : result.hyper_of_likelier, known);
  out.rougher = c.rough, out.uneven = uneven.has_value();
  return out;
}

/// What the recording shows is searched, named and told. `out`: what has been said of it so far, `of_the_file` before the
/// machine was asked.
std::variant<Diagnosis, AnotherPart> searched(const Given& given, bool surfaces_stated, Case& c, EvidenceSearch& first,
                                              std::vector<Diagnostic> of_the_file, Diagnosis out) {
  const auto at = [&](std::string_view step) { begins(given.options.progress, step); };
  const auto is_another_part = [&](const SearchResult& result) {
    return !surfaces_stated && c.baseline.surfaces != Surfaces::unknown && another_part(c, result, out);
  };
  const auto another = [&] { return AnotherPart{not_its_targets(c.touches, kNineTenths, given.file)}; };
  if (out.smallest_detectable.empty()) {
    if (is_another_part({})) return another();
    tell_nothing_judged(c, given.file, out);
    return out;
  }
  c.rough = first.more_likely_rough();
  SearchResult result = search(c, first);
  out.baseline = machine_beside(c, first, result, out.baseline.known);
  out.p_value = result.p_value;
  out.other_methods = other_methods(c, result.first);
  at("touches that the model has not seen");
  show_improvement(c, result, out);
  take_in_runner_up(c, first, out, result);
  tell_findings(c, result, out);
  if (is_another_part(result)) return another();
  if (!result.findings.empty()) out.adequacy_p = result.adequacy;
  if (result.other) tell_unexplained(c, result, out);
  out.location = locate(c, first, result);
  tell_noise(c, judge_noise(c, result), out);
  out.verdict = verdict_of(c, result, out);
  tell_machine(c, result, given.file, out);
  // What rougher errors would explain may be that as well: here errors are large that are so as harmonics.
  const bool large = result.hyper.scale >= kLargeErrors;
  if (c.styli_unlogged && (is_mismatch(out) || large)) return without_styli(std::move(out), std::move(of_the_file));
  at("the next measurement");
  out.next_measurement = next_measurements(c, &result, out.smallest_detectable);
  out.otherwise = otherwise(c, result, out);
  if (given.options.keep_state) out.known_state = known_state_beside(c, result);
  return out;
}

/// `out`: what has been said of the recording so far.
std::variant<Diagnosis, AnotherPart> diagnosed(const Given& given, std::optional<Surfaces> surfaces, Diagnosis out) {
  const DiagnoseOptions& options = given.options;
  const auto at = [&](std::string_view step) { begins(options.progress, step); };
  at("virtual machines of the specification");
  Case c = case_of(given.recording, given.machine, options, surfaces, given.file, out);
  std::vector<Diagnostic> of_the_file = out.messages;
  judge_rounding(given.step_um, c);
  // What holds no error at all says no more than its plan.
  const bool as_planned = !options.design_only && holds_targets_only(given.recording);
  if (as_planned) out.messages.push_back(nothing_but_targets(given.file));
  const bool plan = options.design_only || as_planned;
  if (plan)
    take_plan(c);
  else
    mask_outliers(c);
  at("what each explanation would do to these touches");
  const double reading_step_um = plan ? 0 : kUmPerMm * reading_step_mm(given.recording);
  const std::optional<NoisyGroup> noisy = plan ? std::nullopt : noisy_touches(c);
  std::optional<Case> before = noisy ? std::optional(c) : std::nullopt;  // with readings as they were read
  EvidenceSearch first = search_of(c, plan, reading_step_um);
  if (noisy && explains_more(*noisy, *before, first.evidence())) {
    c = *std::move(before);
    part(noisy->group, c);
    first = search_of(c, plan, reading_step_um);
  }
  at("what this recording could detect");
  tell_power(c, first, out);
  out.baseline = summary(c, c.hyper, given.machine.known_state.has_value());
  if (as_planned) {
    out.judged = Judged::targets_only;
    out.verdict = Verdict::cannot_judge;
    out.otherwise = "Record measured positions: those of a real machine differ from their targets in the last digits.";
    return out;
  }
  if (plan) {
    at("the next measurement");
    out.next_measurement = next_measurements(c, nullptr, out.smallest_detectable);
    return out;
  }
  return searched(given, surfaces.has_value(), c, first, std::move(of_the_file), std::move(out));
}

}  // namespace

std::string_view name(Verdict v) {
  constexpr std::string_view names[] = {"no_mismatch", "named", "one_of", "unexplained", "cannot_judge"};
  return names[static_cast<int>(v)];
}

bool tells_of(const Diagnosis& d, std::string_view effect) {
  const auto is_it = [&](const auto& of) { return of.effect == effect; };
  return std::any_of(d.smallest_detectable.begin(), d.smallest_detectable.end(), is_it) ||
      std::any_of(d.cannot_judge.begin(), d.cannot_judge.end(), is_it);
}

std::vector<Diagnostic> recording_problems(const Recording& recorded, const Machine& machine, const std::string& file) {
  std::vector<Diagnostic> messages, of_placement;
  const Recording once = without_copies(recorded, file, messages);
  check_data(once, machine, file);
  constexpr double kNoSize_mm = 0.5;  // all over: no part deviates so evenly from its drawing
  const bool stated = stated_surfaces(once).has_value();
  const Recording placed =
      put_on_targets(once, stated ? std::numeric_limits<double>::infinity() : kNoSize_mm, file, of_placement);
  const RecordedTouches touches = recorded_touches(placed, machine, file);
  messages.insert(messages.end(), touches.messages.begin(), touches.messages.end());
  check_pairing(placed, touches, file, messages);
  if (!stated) check_tips(touches, file);
  return messages;
}

namespace {

/// `messages`: what has been said of the recording, also where it is refused then.
Diagnosis diagnose_saying(const Recording& recorded, const Machine& machine, const DiagnoseOptions& options,
                          const std::string& file, std::vector<Diagnostic>& messages) {
  Diagnosis out;
  refuse_too_many(recorded, file);
  if (options.design_only) out.judged = Judged::plan;
  const Recording recording =
      options.design_only ? planned(recorded, file, messages) : ready(recorded, machine, options, file, messages);
  out.touches = static_cast<int>(recording.rows.size());
  const double step_um = options.design_only ? 0 : kUmPerMm * common_step_mm(recorded);
  if (std::optional<Diagnostic> contradiction = contradicts_specification(machine, options.seed, options.threads))
    messages.push_back(std::move(*contradiction));
  out.messages = messages;
  const Given given{recording, step_um, machine, options, file};
  std::variant<Diagnosis, AnotherPart> found = diagnosed(given, stated_surfaces(recording), out);
  if (const auto* other = std::get_if<AnotherPart>(&found)) {
    out.messages.push_back(other->told);
    found = diagnosed(given, Surfaces::unknown, std::move(out));
  }
  return std::get<Diagnosis>(std::move(found));
}

}  // namespace

Diagnosis diagnose_recording(const Recording& recorded, const Machine& machine, const DiagnoseOptions& options,
                             const std::string& file) {
  std::vector<Diagnostic> messages;
  try {
    return diagnose_saying(recorded, machine, options, file, messages);
  } catch (const UserError& error) {
    messages.insert(messages.end(), error.diagnostics().begin(), error.diagnostics().end());
    throw UserError(std::move(messages));
  }
}

}  // namespace abbe
