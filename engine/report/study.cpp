#include "engine/report/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "engine/base/ids.hpp"
#include "engine/machine/effect_names.hpp"
#include "engine/report/budget.hpp"
#include "engine/report/influences.hpp"
#include "engine/report/report_unit.hpp"
#include "engine/run/effect_settings.hpp"

namespace abbe {

void check_options(const StudyOptions& options) {
  if (!options.digits && options.machines < 2)
    throw UserError(diagnostic(Code::E0603,
                               fmt::format("{} virtual machines were asked for; expected at least 2", options.machines),
                               "a standard uncertainty needs two values; 1000 machines give it to about 2 %"));
  if (options.digits && *options.digits != 1 && *options.digits != 2)
    throw UserError(diagnostic(
        Code::E0603, fmt::format("{} significant digits of u were asked for; expected 1 or 2", *options.digits),
        "each further digit needs a hundred times as many machines"));
  if (options.coverage && !(*options.coverage > 0 && *options.coverage < 1))
    throw UserError(diagnostic(
        Code::E0603,
        fmt::format("a coverage probability of {:g} was asked for; expected between 0 and 1", *options.coverage),
        *options.coverage > 1 && *options.coverage < 100
            ? fmt::format("{:g} % is {:g}", *options.coverage, *options.coverage / 100)
            : "99 % is 0.99"));
}

namespace {

/// Every contributor acting alone, by the name under which its share is reported.
struct NamedContributors {
  std::string name;
  Contributors contributors;
};

std::vector<NamedContributors> each_alone(const Machine& machine, bool workpiece) {
  const auto only = [](bool geometry, bool head, bool probe, bool effects) {
    Contributors c = Contributors::none();
    c.geometry = geometry, c.head = head, c.probe = probe, c.effects = effects;
    return c;
  };
  std::vector<NamedContributors> list{{"geometry", only(true, false, false, false)},
                                      {"head", only(false, true, false, false)},
                                      {"probe", only(false, false, true, false)}};
  if (workpiece) {
    list.push_back({"part", only(false, false, false, false)});
    list.back().contributors.part = true;
  }
  const std::vector<std::string> names = effect_names(machine.effects);
  for (int i = 0; i < static_cast<int>(names.size()); ++i) {
    list.push_back({names[i], only(false, false, false, true)});
    list.back().contributors.only_effect = i;
  }
  return list;
}

/// The coverage of LCL and UCL.
constexpr double kOfLimits = 0.95;

/// The least whole number that is not below x but for rounding.
double at_least(double x) { return std::ceil(x * (1 - 1e-9)); }

/// Of the figures that are always there, and of the interval of the coverage that was asked for.
struct Trials {
  explicit Trials(int digits) : limits(digits), interval(digits) {}
  AdaptiveTrials limits, interval;
};

/// One study in the making: what all its steps share.
class StudyRun {
 public:
  StudyRun(const plan::Plan& plan, const Machine& machine, const StudyOptions& options, const SourceFile& source,
           const Progress& progress)
      : plan_(plan), machine_(machine), options_(options), source_(source), progress_(progress) {}

  Study run() {
    const int count = options_.digits ? block_machines() : options_.machines;
    step("drawing virtual machines");
    const VirtualMachines machines = screened_machines(machine_, options_.seed, count, options_.threads);
    step("running the program");
    append(machines, run(machines, {}));
    study_.report.messages = study_.result.warnings;
    std::vector<ContributorRun> alone;
    for (const NamedContributors& c : each_alone(machine_, options_.workpiece != nullptr)) {
      step(c.name + " alone");
      alone.push_back({c.name, run(machines, c.contributors)});
    }
    std::optional<BudgetRuns> budget;
    if (options_.budget) budget = budget_runs(machines, alone);
    if (options_.digits) run_until_stable();
    write_report(alone, budget ? &*budget : nullptr);
    return std::move(study_);
  }

 private:
  void step(const std::string& what) const { begins(progress_, what); }

  RunResult run(const VirtualMachines& machines, const Contributors& contributors) const {
    RunOptions options;
    options.seed = options_.seed;
    options.threads = options_.threads;
    options.contributors = contributors;
    options.effect_use = options_.effect_use;
    options.placement_mm = options_.placement_mm;
    options.workpiece = options_.workpiece;
    options.recorded = options_.recorded;
    return run_plan(plan_, machine_, machines, options, source_);
  }

  /// The geometry goes by its error functions; the other sources have run alone already.
  BudgetRuns budget_runs(const VirtualMachines& machines, const std::vector<ContributorRun>& alone) const {
    BudgetRuns runs;
    Contributors only = each_alone(machine_, false).front().contributors;
    for (int k = 0; k < kComponents; ++k) {
      only.only_component = static_cast<Component>(k);
      const std::string component(name(*only.only_component));
      step(component + " alone");
      runs.alone.push_back({component, run(machines, only)});
    }
    runs.alone.insert(runs.alone.end(), alone.begin() + 1, alone.end());
    Contributors some;
    step("alignment against features");
    some.touches = ErroneousTouches::alignment;
    runs.alignment = run(machines, some);
    some.touches = ErroneousTouches::feature;
    runs.feature = run(machines, some);
    return runs;
  }

  /// Joins a further run to the result; its machines are counted on from those already there.
  void append(const VirtualMachines& machines, RunResult part) {
    const auto shift = static_cast<std::uint32_t>(study_.result.machines);
    ScreeningCounts& counts = study_.report.machines;
    counts.generated += machines.counts.generated, counts.failed_mpe += machines.counts.failed_mpe;
    counts.too_small += machines.counts.too_small, counts.used += machines.counts.used;
    study_.candidates.insert(study_.candidates.end(), machines.index.begin(), machines.index.end());
    if (shift == 0) {
      study_.result = std::move(part);
      add_to_trials(study_.result);
      return;
    }
    for (Trap& trap : part.traps) {
      trap.machine += shift;
      study_.result.traps.push_back(std::move(trap));
    }
    for (std::size_t i = 0; i < part.samples.size(); ++i) {
      const Samples& more = part.samples[i];
      Samples& all = study_.result.samples[entry(part, i)];
      all.value.insert(all.value.end(), more.value.begin(), more.value.end());
      all.own_limits.insert(all.own_limits.end(), more.own_limits.begin(), more.own_limits.end());
      for (const std::uint32_t m : more.machine) all.machine.push_back(m + shift);
    }
    study_.result.machines += part.machines;
    study_.result.touches += part.touches;
    add_activities(part.activities, study_.result.activities);
    add_to_trials(part);
  }

  /// Where the result has the evaluation that is entry `i` of `part`; a new entry for one on a path
  /// that only machines of `part` took.
  std::size_t entry(const RunResult& part, std::size_t i) {
    std::vector<Samples>& all = study_.result.samples;
    if (const Samples* known = counterpart(part.samples, i, study_.result)) return known - all.data();
    all.push_back(part.samples[i]);
    all.back().value.clear(), all.back().own_limits.clear(), all.back().machine.clear();
    return all.size() - 1;
  }

  /// JCGM 101, 7.9.4 a: enough values beyond the limits of a block.
  int block_machines() const {
    const double coverage = options_.coverage.value_or(kOfLimits);
    return std::max(
        kBlockMachines,
        static_cast<int>(std::min(at_least(100 / (1 - coverage)), 1.0 * options_.max_blocks * kBlockMachines)));
  }

  void add_to_trials(const RunResult& block) {
    if (!options_.digits) return;
    trials_.resize(study_.result.samples.size(), Trials(*options_.digits));
    for (std::size_t i = 0; i < block.samples.size(); ++i) {
      const Samples& samples = block.samples[i];
      if (samples.value.size() < 2) continue;
      std::vector<double> values = samples.value;
      const double factor = report_unit(plan_, samples.characteristic).factor;
      for (double& v : values) v *= factor;  // the digits are those of the figures reported
      const Summary summary = summarize(values);
      if (summary.u < least_u(samples.characteristic)) continue;  // not known, however many machines there are
      Trials& trials = trials_[entry(block, i)];
      trials.limits.add(summary);
      if (options_.coverage) trials.interval.add(summarize(values, *options_.coverage));
    }
  }

  /// Characteristics that no block could summarise do not count: they are reported as lost, or without u.
  bool stable() const {
    const auto settled = [](const AdaptiveTrials& t) { return t.blocks() == 0 || t.stable(); };
    return std::all_of(trials_.begin(), trials_.end(),
                       [&](const Trials& t) { return settled(t.limits) && settled(t.interval); });
  }

  void run_until_stable() {
    const int block = block_machines(), most = options_.max_blocks * kBlockMachines;
    while (study_.result.machines + block <= most && !stable()) {
      step(fmt::format("{} machines; not yet stable to {} digits", study_.result.machines, *options_.digits));
      const VirtualMachines machines =
          more_screened_machines(machine_, options_.seed, block, options_.threads, study_.candidates.back() + 1);
      append(machines, run(machines, {}));
    }
    if (!stable())
      message(
          Code::W0605,
          fmt::format("the figures are not yet stable to {} digit{} after {} machines, the most that are run for it",
                      *options_.digits, *options_.digits == 1 ? "" : "s", study_.result.machines),
          fmt::format("see the Monte Carlo errors{}",
                      *options_.digits > 1         ? ", or ask for --digits 1"
                          : block > kBlockMachines ? ", or ask for a lower --coverage"
                                                   : ""));
  }

  /// In the unit of the report: what scatters less is rounding.
  double least_u(plan::CharacteristicId id) const {
    const plan::ToleranceDef& tolerance = plan_[plan_[id].tolerance];
    return report_unit(plan_, id).factor * smallest_u(unit_of(*tolerance.kind, tolerance.arguments));
  }

  void message(Code code, std::string text, std::string help) {
    study_.report.messages.push_back(diagnostic(code, std::move(text), std::move(help)));
  }

  void write_report(const std::vector<ContributorRun>& alone, const BudgetRuns* budget) {
    RunReport& report = study_.report;
    report.program = source_.name();
    report.machine = machine_.name;
    if (options_.workpiece) report.workpiece = options_.workpiece->name;
    report.recorded_points = options_.recorded != nullptr;
    if (!machine_.effects.empty()) report.effect_use = options_.effect_use;
    report.seed = options_.seed;
    report.cycle_time_s = study_.result.cycle_time_s;
    report.characteristics = characteristic_reports(plan_, study_.result, alone, budget, options_.coverage);
    Declaration declaration = declare_influences(machine_, study_.result.activities, options_.workpiece, part_in_run());
    report.influences = std::move(declaration.influences);
    std::move(declaration.messages.begin(), declaration.messages.end(), std::back_inserter(report.messages));
    report.traps = study_.result.traps;
    add_unreached();
    warn_of_parting();
    warn_of_fixed_values();
    warn_of_idle_effects();
    warn_of_prolonged_effects();
    warn_of_few_machines();
    warn_of_screening();
    if (study_.result.samples.empty())
      message(Code::W0606, "the program evaluates no characteristic",
              "add an OUTPUT or EVAL statement with a feature and a tolerance");
  }

  PartInRun part_in_run() const {
    const bool switched_on =
        std::any_of(plan_.operations.begin(), plan_.operations.end(), [](const plan::Operation& op) {
          const auto* set = std::get_if<plan::SetTemperatureCompensation>(&op.action);
          return set && set->on;
        });
    return {options_.recorded != nullptr, switched_on || (options_.workpiece && options_.workpiece->compensated)};
  }

  /// Characteristics without figures, because fewer than two machines reached them.
  void add_unreached() {
    for (const Samples& samples : study_.result.samples) {
      if (samples.value.size() >= 2) continue;
      const plan::CharacteristicDef& definition = plan_[samples.characteristic];
      std::string reason = fmt::format("{} of {} machines reached it", samples.value.size(), study_.result.machines);
      if (const auto& traps = study_.result.traps; !traps.empty())
        reason += fmt::format("; the first stopped at line {}: {}", traps.front().line, traps.front().reason);
      std::string features;
      for (const plan::FeatureId f : definition.features) features += (features.empty() ? "" : ", ") + plan_[f].label;
      LostCharacteristic lost{definition.line, features, reason};
      std::vector<LostCharacteristic>& all = study_.report.lost;  // every turn of a loop loses it in the same words
      if (std::find(all.begin(), all.end(), lost) == all.end()) all.push_back(std::move(lost));
    }
  }

  /// Machines that took one path are those with certain errors: their figures are not those of all. Likewise those that
  /// did not stop, where more stopped than the limits leave outside.
  void warn_of_parting() {
    constexpr int kShown = 10;
    constexpr double kStopped = 0.01;
    int parted = 0;
    for (const CharacteristicReport& c : study_.report.characteristics) {
      const bool stopped = c.trapped > kStopped * study_.result.machines;
      if ((c.elsewhere == 0 && !stopped) || ++parted > kShown) continue;
      message(Code::W0619,
              fmt::format("line {}: FA({}),TA({}): {} of {} machines evaluated this: a conditional result", c.line,
                          fmt::join(c.features, "),FA("), c.tolerance, c.evaluated, study_.result.machines),
              c.elsewhere == 0
                  ? "the others stopped before, and what stopped them may go with their errors: the figures "
                    "are not those of the whole process"
                  : c.reference ? "a condition on measured values sent the others past it"
                                : "a condition on measured values sent the others past it, and the error-free "
                                  "machine, so that there is no value to compare with");
    }
    if (parted > kShown)
      message(Code::W0619, fmt::format("{} characteristics in all are conditional results", parted),
              "`abbe run --format json` says of each how many machines `evaluated` it");
  }

  /// Values that come out the same on every machine: their uncertainty is not known, and must not pass for 0.
  void warn_of_fixed_values() {
    constexpr int kShown = 10;
    int fixed = 0;
    for (const CharacteristicReport& c : study_.report.characteristics) {
      if (c.varies || ++fixed > kShown) continue;
      const double shift = c.reference ? c.summary.mean - *c.reference : 0;
      const bool shifted = std::abs(shift) >= least_u(c.characteristic);
      message(
          Code::W0621,
          fmt::format("line {}: FA({}),TA({}): every machine finds the same value{}, because nothing that is modelled "
                      "makes it vary: its uncertainty is not known",
                      c.line, fmt::join(c.features, "),FA("), c.tolerance,
                      shifted ? fmt::format(", {:.3g} {} {} than the error-free machine", std::abs(shift), c.unit,
                                            shift > 0 ? "more" : "less")
                              : ""),
          shifted
              ? "what moves it stands in the files as certain: give its uncertainty there, and the probe its "
                "repeatability; the value that they find is the `mean` of --format json"
              : "a form shows only where more points were touched than settle the feature, as three settle a circle, and not in "
                "what is constructed of other features; no touch shows where a feature lies along itself, as a bore along its axis");
    }
    if (fixed > kShown)
      message(Code::W0621, fmt::format("{} characteristics in all come out the same on every machine", fixed),
              "`abbe run --format json` has no conformance_probability for them");
  }

  /// Effects of the machine file of which nothing is in any figure: an expansion at 20 degrees C, a
  /// size of 0.
  void warn_of_idle_effects() {
    const std::vector<std::string> names = effect_names(machine_.effects);
    const bool corrected = options_.effect_use == EffectUse::corrected;
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (study_.result.activities[k].moved) continue;
      message(Code::W0615,
              fmt::format("{}: it moves no touch of this program, so that nothing of it is in the figures", names[k]),
              why_idle(machine_.effects[k], corrected));
    }
  }

  /// What a diagnosis fitted to the touches of one recording is a guess at other touches.
  void warn_of_prolonged_effects() {
    const std::vector<std::string> names = effect_names(machine_.effects);
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (!study_.result.activities[k].beyond) continue;
      message(
          Code::W0623,
          fmt::format("{}: touches of this program lie beyond what it was fitted to ({}), where it stays as it is at "
                      "the nearest end",
                      names[k], fmt::join(words_of_fit(machine_.effects[k]), ", ")),
          "nothing has shown how large it is there, so its uncertainty is too small: record touches there too and "
          "diagnose them together, or find the physics");
    }
  }

  /// "plane xy", "from_1 100 mm": what is not its size.
  static std::vector<std::string> words_of_fit(const EffectSetting& setting) {
    std::vector<std::string> words;
    for (const EffectParameter& p : find_effect(setting.name)->parameters) {
      const auto given = setting.parameters.find(std::string(p.name));
      if (p.linear || given == setting.parameters.end()) continue;
      const EffectSetting::Value& v = given->second;
      words.push_back(v.word.empty() ? fmt::format("{} {:.4g}", p.name, v.value)
                                     : fmt::format("{} {}", p.name, v.word));
    }
    return words;
  }

  static std::string why_idle(const EffectSetting& setting, bool corrected) {
    if (const EffectParameter* size = missing_size(setting))
      return fmt::format("its {} is 0: give it a size, such as \"{}\": {:g}", size->name, size->name, size->typical);
    if (const double begin_s = begins_at_s(setting); begin_s > 0)
      return fmt::format(
          "it begins {:g} s after the start of a program: of what happened before this program, set its t0_s to 0",
          begin_s);
    if (const int setup = only_in_setup(setting); setup > 1)
      return fmt::format(
          "it is there in setup {} alone, and a program is run in setup 1: where the part is placed as in "
          "setup {}, set its setup to 0",
          setup, setup);
    return fmt::format("`abbe explain {}` says on what it depends; temperatures and loads come from a workpiece file{}",
                       setting.name, corrected ? "; of a corrected effect only the uncertainty remains" : "");
  }

  /// Beyond each end of an interval must be some values, or its ends are those of the sample. LCL and
  /// UCL have their coverage whatever else is asked for.
  void warn_of_few_machines() {
    constexpr double kBeyond = 20;
    const double coverage = std::max(kOfLimits, options_.coverage.value_or(kOfLimits));
    if (study_.result.machines * (1 - coverage) >= kBeyond) return;
    message(Code::W0435, fmt::format("{} machines are few for {:g} % limits", study_.result.machines, 100 * coverage),
            fmt::format("ask for --machines {:.0f} or more; JCGM 101, 7.2.2 recommends {:.0f}",
                        at_least(kBeyond / (1 - coverage)), at_least(1e4 / (1 - coverage))));
  }

  void warn_of_screening() {
    step("looking for a factor on e_max");
    if (auto warning = screening_warning(machine_, study_.report.machines, options_.seed, options_.threads))
      study_.report.messages.push_back(std::move(*warning));
  }

  const plan::Plan& plan_;
  const Machine& machine_;
  const StudyOptions& options_;
  const SourceFile& source_;
  const Progress& progress_;
  Study study_;
  std::vector<Trials> trials_;  ///< one per entry of result.samples
};

}  // namespace

Study run_study(const plan::Plan& plan, const Machine& machine, const StudyOptions& options, const SourceFile& source,
                const Progress& progress) {
  check_options(options);
  return StudyRun(plan, machine, options, source, progress).run();
}

}  // namespace abbe
