#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "engine/diagnose/baseline/calibrated_part.hpp"
#include "engine/diagnose/baseline/known_state.hpp"
#include "engine/diagnose/baseline/length_errors.hpp"
#include "engine/diagnose/baseline/machine_effects.hpp"
#include "engine/diagnose/baseline/outliers.hpp"
#include "engine/diagnose/baseline/own_noise.hpp"
#include "engine/diagnose/baseline/standing.hpp"
#include "engine/diagnose/checks/data_problems.hpp"
#include "engine/diagnose/explanations/same_phase.hpp"
#include "engine/diagnose/findings/caveats.hpp"
#include "engine/diagnose/findings/doubt.hpp"
#include "engine/diagnose/findings/empirical.hpp"
#include "engine/diagnose/findings/improvement.hpp"
#include "engine/diagnose/findings/known_effect.hpp"
#include "engine/diagnose/findings/locate.hpp"
#include "engine/diagnose/findings/members.hpp"
#include "engine/diagnose/findings/noise_effects.hpp"
#include "engine/diagnose/findings/parameters.hpp"
#include "engine/diagnose/findings/scatter.hpp"
#include "engine/diagnose/quantile.hpp"
#include "engine/diagnose/planning/design.hpp"
#include "engine/diagnose/planning/next_measurement.hpp"
#include "engine/diagnose/planning/noise_design.hpp"
#include "engine/diagnose/warnings.hpp"
#include "engine/diagnose/words.hpp"

namespace abbe {

using namespace diagnose;

namespace {

/// What the file says of the surfaces.
std::optional<Surfaces> stated_surfaces(const Recording& r, const std::string& file) {
  const std::optional<std::string> value = said(r.metadata, "surfaces");
  if (!value) return std::nullopt;
  if (*value == "calibrated") return Surfaces::calibrated;
  if (*value == "unknown_size") return Surfaces::unknown_size;
  if (*value == "unknown") return Surfaces::unknown;
  throw UserError(diagnostic(Code::E0703, fmt::format("{}: '# surfaces: {}' is not known", file, *value),
                             "write calibrated, unknown_size or unknown"));
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
  Recording once = without_copies(recorded, file, messages);
  check_data(once, machine, file);
  doubt_temperatures(once, file, messages);
  doubt_speeds(once, file, messages);
  leave_out_partly_logged(once, file, messages);
  leave_out_commanded_readings(once, file, messages);
  continue_past_midnight(once, file, messages);
  count_from_first_touch(once, file, messages);
  return put_on_targets(once, most_out_mm(once, machine, options), file, messages);
}

BaselineSummary summary(const Case& c, const Hyperparameters& hyper, bool known) {
  BaselineSummary b;
  b.known = known;
  b.geometry_scale = hyper.scale;
  b.correlation = hyper.correlation;
  Vector square = Vector::Zero(hyper.noise.size()), rows = square;
  for (Eigen::Index i = 0; i < c.model.y.size(); ++i) {
    const int g = c.model.noise_group[static_cast<std::size_t>(i)];
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

/// Whether several runs share one placement of the part.
bool stays_in_its_setup(const Case& c) {
  std::map<int, int> run_of;
  return std::any_of(c.rows.begin(), c.rows.end(), [&](int row) {
    const TouchScene& s = c.touches.touches[static_cast<std::size_t>(row)].scene;
    return run_of.try_emplace(s.setup, s.run).first->second != s.run;
  });
}

constexpr const char* kOfThisPart = " It is of this part: a machine file with it holds for no other part.";

/// Puts an effect into the machine file: beside the others, or with what the file has of it already. Decides
/// whether that is plausible, and says what is to be said.
std::string tell_machine_file(const Case& c, const Effect& effect, std::vector<DiagnosedParameter>& parameters,
                              Diagnosis& out) {
  EffectSetting setting = setting_of(std::string(effect.name), parameters);
  std::optional<KnownEffect> before = known_effect(*c.machine, effect, setting);
  const auto& taken = out.superseded;
  if (before && std::find(taken.begin(), taken.end(), before->index) != taken.end()) before.reset();
  if (before) setting = before->now;
  setting = nearest_possible(effect, setting);
  const bool gone = before && before->gone;
  if (!gone && !plausible(effect, setting)) return kNoSuchSize;
  for (DiagnosedParameter& p : parameters) p.plausible = true;
  if (before) out.superseded.push_back(before->index);
  if (!gone) out.model_effects.push_back(std::move(setting));
  if (!before) return effect.stage == Stage::part ? kOfThisPart : "";
  return gone           ? " The machine file has the opposite: it is not there any more."
      : before->instead ? " It takes the place of what the machine file has of it."
                        : " That is beside what the machine file has of it.";
}

/// What of a variant changes between runs. Where it stands for a stretch of runs that holds the one of the
/// finding, it is that.
RunChange change_of(const Block& variant, const Block& found) {
  const bool holds = variant.change.is_like(found.change) && variant.runs.low <= found.runs.low &&
      found.runs.high <= variant.runs.high;
  return holds ? found.change : variant.change;
}

/// Whether it is the period of a scale, of which this recording shows one phase in each direction.
bool is_same_phase(const Case& c, const Finding& f) {
  const Effect* effect = c.explanations.list[static_cast<std::size_t>(f.explanation)].effect;
  return effect && needs_raw_reading(*effect) &&
      SameDirection(c.touches, c.rows).is_alike(c.explanations.blocks[static_cast<std::size_t>(f.block)].signature);
}

/// Findings as effects of the answer and as settings of a machine file.
void tell_findings(const Case& c, const SearchResult& result, Diagnosis& out) {
  for (std::size_t k = 0; k < result.findings.size(); ++k) {
    const Finding& f = result.findings[k];
    DiagnosedEffect e;
    for (const int m : f.set) {
      const Explanation& member = c.explanations.list[m];
      e.members.push_back(member.name);
      const int likeliest = m == f.explanation ? f.block : best_block(c.explanations, m, f.evidence);
      e.change.push_back(change_of(c.explanations.blocks[static_cast<std::size_t>(likeliest)],
                                   c.explanations.blocks[static_cast<std::size_t>(f.block)]));
    }
    const bool something_else = result.other || result.adequacy < kInadequate;
    FoundSize size = estimate_size(c, result, k);
    e.parameters = std::move(size.parameters);
    e.largest_um = size.largest_um;
    const RunChange change = e.change.front();
    const bool rounding = may_be_rounding(c, e.largest_um);
    const Effect& effect = *c.explanations.list[f.explanation].effect;
    const std::string clock = whose_clock(c, effect);
    const std::string in_file = change.gone() ? " It is gone: the machine file needs nothing of it."
        : !clock.empty()                      ? " Until then no machine file carries it."
        : rounding
        ? fmt::format(
              " It may come from the rounding of the positions to {:g} um, and no machine file carries it: record the digits that the machine has.",
              c.step_um)
        : belief_in_first(c, f) < kCarried ? " It is one of so many that no machine file carries it."
                                           : tell_machine_file(c, effect, e.parameters, out);
    const bool possible = plausible(e.parameters);
    const bool same_phase = is_same_phase(c, f);
    const bool doubted = something_else || rounding || c.styli_unlogged || same_phase || effect.only_spread ||
        !judged(c, f) || !possible || !shown(out.improvement);
    e.probability = believed(f.probability, doubted);
    if (f.set.size() > 1) e.by_member = members_of(c, result, k, e);
    std::vector<std::string_view> titles;
    for (const int m : f.set) titles.push_back(c.explanations.list[m].effect->title);
    const bool unsure = e.probability < kTold;
    e.sentence = explanation_sentence(titles, e.parameters, "this recording", change, unsure, /*beside=*/k > 0) +
        pattern_beside(c, f) + (same_phase ? kSamePhase : "") + much_like_it(effect) + whose_coordinates(c, effect) +
        clock + in_file;
    if (change.any() && stays_in_its_setup(c))
      e.sentence +=
          " That takes for granted that the part did not move between the runs; if it may have, give them different setups.";
    out.effects.push_back(std::move(e));
  }
}

/// What no effect explains, and the pattern that a machine file may carry for it.
void tell_unexplained(const Case& c, const SearchResult& result, Diagnosis& out) {
  const bool as_well =
      out.improvement && out.runner_up && out.runner_up->log_score_gain >= out.improvement->log_score_gain;
  out.unexplained = describe_unexplained(
      c, result, as_well ? fmt::format("{}", fmt::join(out.runner_up->members, " or ")) : std::string());
  EmpiricalModel model = empirical_model(c, result);
  if (model.follows) out.unexplained->model_follows = abbe::diagnose::name(*model.follows);
  if (!model.settings.empty()) out.unexplained->model = model.settings.front().name;
  for (EffectSetting& setting : model.settings) out.model_effects.push_back(std::move(setting));
}

/// The geometry of this machine beside what was found: findings are free, so that no error function takes them over.
std::string known_state_beside(const Case& c, const SearchResult& result) {
  Baseline beside = c.baseline;
  beside.model = with_free(without_rows(c.baseline.model, c.masked), signatures_of(c, result));
  return write_known_state(posterior(beside, result.hyper), result.hyper);
}

/// One recording in so many has a change of the scatter.
constexpr double kPriorScatter = 0.01;

void tell_noise(const Case& c, std::vector<NoiseFinding> noise, Diagnosis& out) {
  for (NoiseFinding& n : noise) {
    const std::string in_file = tell_machine_file(c, *n.effect, n.parameters, out);
    if (n.factor && out.effects.empty() && !out.unexplained)
      out.location.push_back({std::string(abbe::diagnose::name(*n.factor)), n.where, 1, n.p});
    out.effects.push_back({{std::string(n.effect->name)},
                           believed(most_believed(n.p, kPriorScatter), out.unexplained || !n.certain),
                           n.parameters,
                           n.sentence});
    if (!n.certain)
      out.effects.back().sentence +=
          " Repeats of the same touches would tell whether it is noise, or a pattern too fine for this recording.";
    out.effects.back().sentence += in_file;
    out.p_value = std::min(out.p_value, n.p);
  }
}

Verdict verdict_of(const Case& c, const SearchResult& result, const Diagnosis& d) {
  if (result.other) return Verdict::unexplained;
  if (result.findings.empty()) return d.effects.empty() ? Verdict::no_mismatch : Verdict::named;
  bool open = c.styli_unlogged, several = false;
  for (const Finding& f : result.findings) {
    open = open || !judged(c, f);
    several = several || f.set.size() > 1;
  }
  return open ? Verdict::cannot_judge : several ? Verdict::one_of : Verdict::named;
}

/// An effect that could be judged but would not show at any size is hidden by what is unknown of the part.
void add_hidden(const Case& c, Diagnosis& out) {
  for (const Explanation& e : c.explanations.list) {
    const auto is_it = [&](const auto& told) { return told.effect == e.name; };
    if (e.effect && std::none_of(out.smallest_detectable.begin(), out.smallest_detectable.end(), is_it) &&
        std::none_of(out.cannot_judge.begin(), out.cannot_judge.end(), is_it))
      out.cannot_judge.push_back({e.name, {}, {}});
  }
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
  out.judgeable = false;
  out.verdict = Verdict::cannot_judge;
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
                  [](const DiagnosedEffect& e) { return !plausible(e.parameters); });
}

/// `surfaces`: what they count as; without, they are what the targets say unless half of them is not.
Case on_the_bench(const Recording& recording, const Machine& machine, const DiagnoseOptions& options,
                  std::optional<Surfaces> surfaces, const std::string& file, Diagnosis& out) {
  Case c;
  c.recording = &recording;
  c.machine = &machine;
  c.options = options;
  c.touches = recorded_touches(recording, machine, file);
  out.messages.insert(out.messages.end(), c.touches.messages.begin(), c.touches.messages.end());
  c.styli_unlogged = styli_unlogged(recording, file, out.messages);
  constexpr int kLeastTouches = 12;
  if (static_cast<int>(c.touches.touches.size()) < kLeastTouches)
    throw UserError(diagnostic(
        Code::E0705, fmt::format("{}: {} touches are too few to judge a machine by", file, c.touches.touches.size()),
        fmt::format("at least {} are needed beyond the six unknowns of each placement", kLeastTouches)));
  if (!options.design_only) check_pairing(recording, c.touches, file, out.messages);
  if (!options.design_only && !surfaces) check_tips(c.touches, file);
  constexpr int kMostTouches = 4000;  // minutes, and less than 2 GB
  if (static_cast<int>(c.touches.touches.size()) > kMostTouches)
    throw UserError(diagnostic(
        Code::E0719, fmt::format("{}: {} touches are too many to be judged together", file, c.touches.touches.size()),
        fmt::format("at most {}: leave out repeats, or diagnose a part of the runs at a time", kMostTouches)));
  const EffectSet effects(machine.effects, EffectUse::left_in, machine.name);
  remove_estimates(effects, c.touches);
  std::optional<RecordedPart> part;
  if (options.workpiece) part = recorded_part(*options.workpiece, recording, c.touches, file);
  if (part)
    remove_expected(*part, c.touches),
        out.messages.insert(out.messages.end(), part->messages.begin(), part->messages.end());
  std::optional<KnownGeometry> known;
  if (machine.known_state) known = known_geometry(*machine.known_state);
  if (!surfaces && within_mm(c.touches, kHalfOfThem) > kBeyondMachines_mm) {
    surfaces = Surfaces::unknown;
    out.messages.push_back(not_its_targets(c.touches, kHalfOfThem, file));
  }
  c.baseline =
      baseline_of(c.touches, machine,
                  {surfaces.value_or(Surfaces::calibrated), known ? &*known : nullptr, options.seed, options.threads});
  if (!known && c.baseline.surfaces == Surfaces::calibrated && !options.design_only)
    out.beyond = c.baseline.beyond = beyond_specification(c.touches, without_placement(c.baseline.model), machine);
  if (out.beyond) hold_to_specification(c.baseline.model);
  add_doubts(effects, c.touches, c.baseline);
  if (part) calibrate(*part, c.touches, c.baseline);
  return c;
}

/// Rounding is noise too: without it, what is rounded coarsely would lie on its steps without any.
void add_rounding(double step_um, Case& c) {
  c.step_um = step_um;
  const double rounding_um = step_um / std::sqrt(12.0);
  Vector& noise_um = c.baseline.model.noise_um;
  if (rounding_um < kLeastRounding * noise_um.mean()) return;
  c.rounding_um = rounding_um;
  noise_um = (noise_um.array().square() + rounding_um * rounding_um).sqrt();
  c.baseline.model.quietest = std::max(c.baseline.model.quietest, rounding_um / noise_um.mean());
}

/// `step_um`: of which the positions were multiples as they were read. `out`: what has been said of the recording so far.
Diagnosis diagnosed(const Recording& recording, double step_um, const Machine& machine, const DiagnoseOptions& options,
                    std::optional<Surfaces> surfaces, const std::string& file, Diagnosis out) {
  const Diagnosis before = out;
  const auto at = [&](std::string_view step) { begins(options.progress, step); };
  at("virtual machines of the specification");
  Case c = on_the_bench(recording, machine, options, surfaces, file, out);
  add_rounding(step_um, c);
  // What holds no error at all says no more than its plan.
  const bool as_planned = !options.design_only && holds_targets_only(recording);
  if (as_planned) out.messages.push_back(nothing_but_targets(file));
  const bool plan = options.design_only || as_planned;
  if (plan) {
    c.masked.assign(c.touches.touches.size(), 0);
    c.model = compact(c.baseline.model);
    c.model.y.setZero();
    c.hyper.noise = Vector::Ones(c.model.noise_groups);
    for (std::size_t i = 0; i < c.masked.size(); ++i) c.rows.push_back(static_cast<int>(i));
  } else {
    mask_outliers(c);
  }
  at("what each explanation would do to these touches");
  c.explanations = explanations_without_readings(c.touches, c.rows);
  EvidenceSearch first(c.model, c.hyper, c.explanations);
  const std::size_t without_readings = c.explanations.blocks.size();
  if (!plan) free_readings_of_noise(c, first);
  add_explanations_of_readings(c.touches, c.rows, c.step_um, c.explanations);
  first.extend(c.explanations, without_readings);
  out.cannot_judge = cannot_judge(c.explanations);
  at("what this recording could detect");
  out.smallest_detectable = smallest_detectable(c, first);
  add_hidden(c, out);
  if (!out.smallest_detectable.empty()) add_smallest_scatter(c, out);
  const bool known = machine.known_state.has_value();
  if (plan) {
    out.baseline = summary(c, c.hyper, known);
    if (as_planned) return out;
    at("the next measurement");
    out.next_measurement = next_measurements(c, nullptr, out.smallest_detectable);
    return out;
  }
  const auto as_another_part = [&] {
    Diagnosis again = before;
    again.messages.push_back(not_its_targets(c.touches, kNineTenths, file));
    return diagnosed(recording, step_um, machine, options, Surfaces::unknown, file, std::move(again));
  };
  const bool may_be_another = !surfaces && c.baseline.surfaces != Surfaces::unknown;
  if (out.smallest_detectable.empty()) {
    out.baseline = summary(c, c.hyper, known);
    if (may_be_another && another_part(c, {}, out)) return as_another_part();
    tell_nothing_judged(c, file, out);
    return out;
  }
  c.rough = first.rough() > 0.5;
  SearchResult result = search(c, first);
  put_judged_members_first(c, result);
  drop_impossible_members(c, result);
  out.baseline = summary(c, result.hyper, known);
  out.p_value = result.p_value;
  out.rivals = rivals(c, result.first);
  at("touches that the model has not seen");
  show_improvement(c, result, out);
  tell_findings(c, result, out);
  if (may_be_another && another_part(c, result, out)) return as_another_part();
  if (!result.findings.empty()) out.adequacy_p = result.adequacy;
  if (result.other) tell_unexplained(c, result, out);
  out.location = locate(c, first, result);
  tell_noise(c, judge_noise(c, result), out);
  out.verdict = verdict_of(c, result, out);
  if (out.beyond && out.effects.empty()) out.messages.push_back(beyond_its_specification(*out.beyond, file));
  const bool only_noise = result.findings.empty() && !result.other;
  if (!known && only_noise && !out.beyond && out.baseline.geometry_scale >= kLargeErrors)
    out.messages.push_back(large_errors(out.baseline.geometry_scale, deviations(c.model, out.baseline.noise_um), file));
  const bool of_noise = std::any_of(out.effects.begin(), out.effects.end(),
                                    [](const DiagnosedEffect& e) { return e.members.front().starts_with("noise."); });
  out.baseline.noisier = !of_noise && scatters_more(out.baseline, out.touches);
  if (out.baseline.noisier) out.messages.push_back(more_scatter(out.baseline, file));
  if (known && result.hyper.scale > kAnotherMachine) out.beyond_known = result.hyper.scale;
  if (out.beyond_known) out.messages.push_back(another_machine(*out.beyond_known, file));
  at("the next measurement");
  out.next_measurement = next_measurements(c, &result, out.smallest_detectable);
  out.otherwise = otherwise(c, result, out.next_measurement);
  if (options.keep_state) out.known_state = known_state_beside(c, result);
  return out;
}

}  // namespace

std::string_view name(Verdict v) {
  constexpr std::string_view names[] = {"no_mismatch", "named", "one_of", "unexplained", "cannot_judge"};
  return names[static_cast<int>(v)];
}

std::vector<Diagnostic> recording_problems(const Recording& recorded, const Machine& machine, const std::string& file) {
  std::vector<Diagnostic> messages, of_placement;
  const Recording once = without_copies(recorded, file, messages);
  check_data(once, machine, file);
  constexpr double kNoSize_mm = 0.5;  // all over: no part deviates so evenly from its drawing
  const bool stated = stated_surfaces(once, file).has_value();
  const Recording placed =
      put_on_targets(once, stated ? std::numeric_limits<double>::infinity() : kNoSize_mm, file, of_placement);
  const RecordedTouches touches = recorded_touches(placed, machine, file);
  messages.insert(messages.end(), touches.messages.begin(), touches.messages.end());
  check_pairing(placed, touches, file, messages);
  if (!stated) check_tips(touches, file);
  return messages;
}

Diagnosis diagnose_recording(const Recording& recorded, const Machine& machine, const DiagnoseOptions& options,
                             const std::string& file) {
  Diagnosis out;
  out.judged = !options.design_only;
  const Recording recording = options.design_only ? recorded : ready(recorded, machine, options, file, out.messages);
  out.touches = static_cast<int>(recording.rows.size());
  return diagnosed(recording, options.design_only ? 0 : kUmPerMm * common_step_mm(recorded), machine, options,
                   stated_surfaces(recording, file), file, std::move(out));
}

}  // namespace abbe
