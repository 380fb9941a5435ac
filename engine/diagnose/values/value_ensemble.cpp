#include "engine/diagnose/values/value_ensemble.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "engine/base/letter_case.hpp"
#include "engine/diagnose/values/value_signature.hpp"
#include "engine/lanes/random.hpp"
#include "engine/recording/units.hpp"
#include "engine/run/run.hpp"

namespace abbe::diagnose {

namespace {

std::vector<std::string> labels_of(const plan::Plan& plan, plan::CharacteristicId id) {
  std::vector<std::string> labels;
  for (const plan::FeatureId f : plan[id].features) labels.push_back(upper(plan[f].label));
  labels.push_back(upper(plan[plan[id].tolerance].label));
  return labels;
}

/// Whether a row means this characteristic: the same tolerance, and the same features where it names any.
bool means(const std::vector<std::string>& row, const std::vector<std::string>& of) {
  return row.size() == 1 ? row.back() == of.back() : row == of;
}

/// The row's value among those that the error-free machine evaluated.
const Samples& sample_of(const ValueRecording& recording, const ValueRow& row, const plan::Plan& plan,
                         const RunResult& result) {
  const std::vector<std::string> labels = abbe::labels_of(row.characteristic);
  std::vector<const Samples*> found;
  std::set<std::string> names, meant;
  int met = 0;
  for (const Samples& s : result.samples) {
    if (!s.reference) continue;
    const std::vector<std::string> of = labels_of(plan, s.characteristic);
    const std::string& label = *names.insert(fmt::format("{}", fmt::join(of, " "))).first;
    if (row.ordinal > 0) {
      if (!labels.empty() && labels.back() == of.back() && ++met == row.ordinal) found.push_back(&s);
    } else if (!labels.empty() && means(labels, of)) {
      meant.insert(label);
      if (++met == row.occurrence) found.push_back(&s);
    }
  }
  if (found.size() == 1 && meant.size() <= 1) return *found.front();
  const std::vector<std::string_view> known(names.begin(), names.end());
  if (meant.size() > 1)
    throw UserError(diagnostic_at(recording.source, row.span, Code::E0550,
                                  fmt::format("the program evaluates '{}' of several features", row.characteristic),
                                  fmt::format("name the features too: {}", fmt::join(known, ", "))));
  const std::string near = nearest_word(fmt::format("{}", fmt::join(labels, " ")), known);
  throw UserError(diagnostic_at(recording.source, row.span, Code::E0556,
                                fmt::format("the program does not evaluate '{}'{}", row.characteristic,
                                            std::max(row.occurrence, row.ordinal) > 1
                                                ? fmt::format(" {} times", std::max(row.occurrence, row.ordinal))
                                                : ""),
                                near.empty() ? fmt::format("it evaluates: {}", fmt::join(known, ", "))
                                             : fmt::format("did you mean '{}'?", near)));
}

double engine_scale(bool angle) { return angle ? kUradPerRad : kUmPerMm; }

/// How a program is run whose values are compared.
RunOptions run_options(const ValueProgram& program, int repeat, const DiagnoseOptions& asked) {
  RunOptions options;
  options.seed = asked.seed;
  options.threads = asked.threads;
  options.repeat = repeat;
  options.placement_mm = program.placement_mm;
  options.workpiece = asked.workpiece;
  return options;
}

/// One run of one program: which rows it fills.
struct OneRun {
  int program = 0, repeat = 0;
  std::vector<int> rows;
};

std::vector<OneRun> runs_of(const ValueRecording& recording, const std::vector<ValueProgram>& programs) {
  std::set<int> numbers;
  for (const ValueRow& row : recording.rows) numbers.insert(row.run);
  const std::vector<int> order(numbers.begin(), numbers.end());
  std::map<std::pair<int, int>, OneRun> runs;
  for (std::size_t r = 0; r < recording.rows.size(); ++r) {
    const ValueRow& row = recording.rows[r];
    const auto program =
        std::find_if(programs.begin(), programs.end(), [&](const ValueProgram& p) { return p.name == row.program; });
    ABBE_CHECK(program != programs.end());
    const int p = static_cast<int>(program - programs.begin());
    const int number = static_cast<int>(std::lower_bound(order.begin(), order.end(), row.run) - order.begin());
    OneRun& run = runs[{p, number}];
    run.program = p;
    run.repeat = p * static_cast<int>(order.size()) + number;
    run.rows.push_back(static_cast<int>(r));
  }
  std::vector<OneRun> list;
  for (auto& [key, run] : runs) list.push_back(std::move(run));
  return list;
}

class EnsembleRuns {
 public:
  EnsembleRuns(const ValueRecording& recording, const Machine& machine, const DiagnoseOptions& options,
               const VirtualMachines& machines, ValueEnsemble& out)
      : recording_(recording), machine_(machine), options_(options), machines_(machines), out_(out) {
    out.values.resize(recording.rows.size());
    out.simulated = Matrix::Constant(machines.size(), static_cast<Eigen::Index>(recording.rows.size()), std::nan(""));
  }

  void add(const OneRun& run, const ValueProgram& program) {
    const RunResult result =
        run_plan(*program.plan, machine_, machines_, run_options(program, run.repeat, options_), *program.source);
    for (const int r : run.rows) add_row(r, run, program, result);
  }

 private:
  /// A value, or a calibrated one, that is what the program measures, in mm or degrees, in another unit.
  void refuse_unit(const ValueRow& row, double measured, bool angle) const {
    // less, of a form or a position, is rounding of what the program says, and an angle may err by its size
    const double least = angle ? 1 : 1e-3;
    if (std::abs(measured) < least) return;
    for (const std::optional<double>& written : {std::optional(row.value), row.reference}) {
      if (!written) continue;
      std::optional<std::string_view> unit;
      if (angle)
        unit = foreign_angle(*written, measured);
      else if (const auto length = foreign_unit(*written, measured))
        unit = length->name;
      if (unit)
        throw UserError(
            diagnostic_at(recording_.source, row.span, Code::E0701,
                          fmt::format("'{}' is {:.6g} {} on an error-free machine, {:.6g} here: it is in {}",
                                      row.characteristic, measured, angle ? "degrees" : "mm", *written, *unit),
                          "value, reference and U are in millimetres or degrees"));
    }
  }

  static constexpr double kMost = 10;  ///< mm or degrees

  /// A calibrated length that no part of this program has: its errors are those of another one.
  void refuse_other_program(const ValueRow& row, double measured_mm) const {
    if (!row.reference || std::abs(*row.reference - measured_mm) <= kMost) return;
    throw UserError(
        diagnostic_at(recording_.source, row.span, Code::E0701,
                      fmt::format("'{}' is {:.6g} mm by its reference and {:.6g} mm on an error-free machine: its "
                                  "program is another one",
                                  row.characteristic, *row.reference, measured_mm),
                      "name the program that evaluated this value, and the characteristic as it has it"));
  }

  /// A value, or a calibrated one, below zero of what has no sign: of a form, a position or a size.
  void refuse_negative(const ValueRow& row, const plan::ToleranceDef& tolerance, const Samples& s) const {
    constexpr double kRounding_mm = 1e-6;  // a form of nothing may come out as so little less
    if (s.limits.lower && tolerance.kind->size_factor == 0) return;
    for (const std::optional<double>& written : {std::optional(row.value), row.reference})
      if (written && *written < -kRounding_mm)
        throw UserError(diagnostic_at(
            recording_.source, row.span, Code::E0701,
            fmt::format("'{}' is {:.6g} mm here: {} of this program is never below 0", row.characteristic, *written,
                        tolerance.kind->word),
            "check this line; where the software gives a deviation a sign, write what the program asks for: the width of a zone, a size"));
  }

  /// A difference that no error of measurement makes: another part, another place, a slip of the pen.
  void refuse_stranger(const ValueRow& row, double reference, bool angle) const {
    const double off = std::abs(row.value - reference);
    if (off <= kMost && row.expanded_uncertainty <= kMost) return;
    const std::string unit = angle ? "degrees" : "mm";
    throw UserError(diagnostic_at(
        recording_.source, row.span, Code::E0701,
        off > kMost
            ? fmt::format("'{}' is {:.6g} {unit} here and {:.6g} {unit} {}: no error of measurement is so large",
                          row.characteristic, row.value, reference,
                          row.reference ? "by its reference" : "on an error-free machine", fmt::arg("unit", unit))
            : fmt::format("an uncertainty U of {:.6g} {} calibrates nothing", row.expanded_uncertainty, unit),
        "check value, reference, U and program of this line: they are of one characteristic, in millimetres or degrees"));
  }

  void add_row(int r, const OneRun& run, const ValueProgram& program, const RunResult& result) {
    const ValueRow& row = recording_.rows[r];
    const Samples& s = sample_of(recording_, row, *program.plan, result);
    if (!met_.insert({run.repeat, s.characteristic.value, s.occurrence}).second)
      throw UserError(diagnostic_at(
          recording_.source, row.span, Code::E0551,
          fmt::format("'{}' stands here for the second time in run {}", row.characteristic, row.run),
          "number repeats in the column 'run', further evaluations in one program in the column 'occurrence'"));
    const plan::ToleranceDef& tolerance = (*program.plan)[(*program.plan)[s.characteristic].tolerance];
    const bool angle = unit_of(*tolerance.kind, tolerance.arguments) == Unit::rad;
    refuse_unit(row, angle ? in_degrees(*s.reference) : *s.reference, angle);
    if (!angle) {
      refuse_negative(row, tolerance, s);
      refuse_other_program(row, *s.reference);
    }
    RecordedValue v{run.program, run.repeat, s.characteristic, s.occurrence, angle};
    v.reference = row.reference.value_or(*s.reference * engine_scale(angle) * v.reported());
    refuse_stranger(row, v.reference, angle);
    v.deviation = (row.value - v.reference) / v.reported();
    v.calibration = row.expanded_uncertainty / 2 / v.reported();
    const std::string artefact = !row.artefact.empty()
        ? row.artefact
        : fmt::format("{}\n{}\n{}", run.program, s.characteristic.value, s.occurrence);
    v.artefact = artefact_.emplace(artefact, static_cast<int>(artefact_.size())).first->second;
    out_.values[r] = v;
    for (std::size_t i = 0; i < s.value.size(); ++i)
      out_.simulated(static_cast<Eigen::Index>(s.machine[i]), r) = engine_scale(angle) * (s.value[i] - *s.reference);
  }

  const ValueRecording& recording_;
  const Machine& machine_;
  const DiagnoseOptions& options_;
  const VirtualMachines& machines_;
  ValueEnsemble& out_;
  std::map<std::string, int> artefact_;
  std::set<std::tuple<int, int, int>> met_;  ///< repeat, characteristic, occurrence
};

}  // namespace

std::vector<Eigen::Index> of_figures(const std::vector<RecordedValue>& values) {
  const bool lengths = std::any_of(values.begin(), values.end(), [](const RecordedValue& v) { return !v.angle; });
  std::vector<Eigen::Index> out;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (values[k].angle != lengths) out.push_back(static_cast<Eigen::Index>(k));
  return out;
}

double RecordedValue::reported() const { return angle ? in_degrees(1) / kUradPerRad : 1 / kUmPerMm; }

VirtualMachines chosen(const VirtualMachines& all, const std::vector<Eigen::Index>& at) {
  VirtualMachines out;
  for (const Eigen::Index i : at) {
    out.index.push_back(all.index[static_cast<std::size_t>(i)]);
    out.geometry.push_back(all.geometry[static_cast<std::size_t>(i)]);
    out.v.push_back(all.v[static_cast<std::size_t>(i)]);
  }
  return out;
}

VirtualMachines first_of(const VirtualMachines& all, Eigen::Index count) {
  std::vector<Eigen::Index> first(static_cast<std::size_t>(std::min<Eigen::Index>(count, all.size())));
  std::iota(first.begin(), first.end(), 0);
  return chosen(all, first);
}

std::vector<Eigen::Index> complete_rows(const Matrix& m) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    if (m.row(i).allFinite()) kept.push_back(i);
  return kept;
}

Matrix complete(const Matrix& m) { return m(complete_rows(m), Eigen::all); }

std::vector<RecordedValue> one_repeat(std::vector<RecordedValue> values) {
  for (RecordedValue& v : values) v.repeat = v.program;
  return values;
}

Matrix simulated_values(const std::vector<RecordedValue>& values, const std::vector<ValueProgram>& programs,
                        const Machine& machine, const VirtualMachines& machines, const DiagnoseOptions& options,
                        const Contributors& contributors) {
  Matrix out = Matrix::Constant(machines.size(), static_cast<Eigen::Index>(values.size()), std::nan(""));
  std::map<int, int> programs_by_repeat;
  for (const RecordedValue& v : values) programs_by_repeat[v.repeat] = v.program;
  for (const auto& [repeat, p] : programs_by_repeat) {
    const ValueProgram& program = programs[p];
    RunOptions run = run_options(program, repeat, options);
    run.contributors = contributors;
    const RunResult result = run_plan(*program.plan, machine, machines, run, *program.source);
    for (std::size_t k = 0; k < values.size(); ++k) {
      const RecordedValue& v = values[k];
      if (v.repeat != repeat) continue;
      for (const Samples& s : result.samples)
        if (s.characteristic == v.characteristic && s.occurrence == v.occurrence && s.reference)
          for (std::size_t i = 0; i < s.value.size(); ++i)
            out(static_cast<Eigen::Index>(s.machine[i]), static_cast<Eigen::Index>(k)) =
                engine_scale(v.angle) * (s.value[i] - *s.reference);
    }
  }
  return out;
}

Matrix as_recorded(Matrix m, const Matrix& recorded, std::uint64_t seed) {
  constexpr std::uint32_t stream = stream_of("diagnose.values.calibration");
  for (Eigen::Index k = 0; k < recorded.cols(); ++k) {
    std::vector<Eigen::Index> errs;  // of a value's rounding it alone, of a calibration those of the artefact
    for (Eigen::Index j = 0; j < recorded.rows(); ++j)
      if (recorded(j, k) != 0) errs.push_back(j);
    if (errs.empty()) continue;
    for (Eigen::Index i = 0; i < m.rows(); ++i) {
      const double error = normal_quantile(
          uniform_pair({seed, static_cast<std::uint32_t>(i), stream, static_cast<std::uint32_t>(k), 0, 0}).a);
      for (const Eigen::Index j : errs) m(i, j) += recorded(j, k) * error;
    }
  }
  return m;
}

ValueEnsemble value_ensemble(const ValueRecording& recording, const std::vector<ValueProgram>& programs,
                             const Machine& machine, const VirtualMachines& machines, const DiagnoseOptions& options) {
  ValueEnsemble out;
  EnsembleRuns runs(recording, machine, options, machines, out);
  for (const OneRun& run : runs_of(recording, programs)) runs.add(run, programs[run.program]);
  out.explanations = value_explanations(out.values, programs, machine, machines, options);
  const std::vector<Eigen::Index> reach = complete_rows(out.simulated);
  out.simulated = Matrix(out.simulated(reach, Eigen::all));
  out.machines = chosen(machines, reach);
  return out;
}

}  // namespace abbe::diagnose
