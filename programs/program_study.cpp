#include "programs/program_study.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "engine/base/file_kind.hpp"
#include "engine/base/files.hpp"
#include "engine/run/check_plan.hpp"
#include "programs/recorded_points.hpp"
#include "programs/thread_count.hpp"

namespace abbe {

std::string beside(const std::string& file, const std::string& path) {
  return (std::filesystem::path(file).parent_path() / path).string();
}

std::string machine_name(const CompiledProgram& program, const std::optional<std::string>& chosen) {
  if (chosen) return *chosen;
  const std::string asked = program.compilation.directives.machine.value_or(kDefaultMachine);
  const std::string file = beside(program.source.name(), asked);
  return is_there(file) ? file : asked;
}

CompiledProgram compile_program(const std::string& path, const lang::CompileOptions& options) {
  Sink sink;
  SourceFile source = read_text(path, sink);
  refuse_other_kind(source, FileKind::program);
  lang::Compilation compilation = lang::compile(source, sink, options);
  return {std::move(source), std::move(compilation), sink.sorted(), sink.has_errors()};
}

std::vector<std::string> files_compiled(const CompiledProgram& program) {
  std::vector<std::string> files = program.compilation.modules;
  files.push_back(program.source.name());
  return files;
}

std::vector<std::string> files_of(const std::optional<Workpiece>& workpiece) {
  if (!workpiece) return {};
  if (workpiece->log_file.empty()) return {workpiece->source.name()};
  return {workpiece->source.name(), workpiece->log_file};
}

namespace {

/// What `read` gives; errors without a place are those of the directive that named the file.
template <class Read>
auto read_named(const SourceFile& program, Span directive, Read read) {
  try {
    return read();
  } catch (const UserError& error) {
    throw UserError(placed(error, program, directive));
  }
}

}  // namespace

std::optional<Workpiece> workpiece_of(const CompiledProgram& program, const std::optional<std::string>& chosen) {
  if (chosen) return read_workpiece(*chosen);
  const lang::Directives& directives = program.compilation.directives;
  if (!directives.workpiece) return std::nullopt;
  return read_named(program.source, directives.workpiece_span,
                    [&] { return read_workpiece(beside(program.source.name(), *directives.workpiece)); });
}

std::vector<Diagnostic> placed(const UserError& error, const SourceFile& program, Span directive) {
  std::vector<Diagnostic> out;
  for (const Diagnostic& d : error.diagnostics())
    out.push_back(d.span ? d : diagnostic_at(program, directive, d.code, d.message, d.help));
  return out;
}

StudyInputs read_inputs(const CompiledProgram& program, const StudySettings& settings) {
  StudyInputs in;
  const lang::Directives& asked = program.compilation.directives;
  in.machine_name = machine_name(program, settings.machine);
  const auto machine = [&] { return read_machine(in.machine_name); };
  in.machine = asked.machine && !settings.machine ? read_named(program.source, asked.machine_span, machine) : machine();
  in.workpiece = workpiece_of(program, settings.workpiece);
  in.files = files_compiled(program);
  in.files.push_back(in.machine_name);
  for (const std::string& file : files_of(in.workpiece)) in.files.push_back(file);
  if (settings.recording) {
    Sink sink;
    const SourceFile recording = read_text(*settings.recording, sink);
    refuse_other_kind(recording, FileKind::table);
    in.recording = read_recording(recording);
    in.messages = sink.list();
    in.messages.insert(in.messages.end(), in.recording->messages.begin(), in.recording->messages.end());
    in.files.push_back(*settings.recording);
    if (in.recording->in_part_frame)
      throw UserError(diagnostic(
          Code::E0525,
          fmt::format(
              "{}: its points are in part coordinates, and errors of a machine are added in machine coordinates",
              *settings.recording),
          "record machine coordinates (without the line '# frame: part'); `abbe diagnose` carries part coordinates over, `abbe run` does not"));
  }
  return in;
}

Placement placement_of(const CompiledProgram& program, const Machine& machine) {
  if (const auto& asked = program.compilation.directives.place_mm) return {*asked, {}};
  return find_placement(program.compilation.plan, machine, program.source);
}

namespace {

void compile_again(CompiledProgram& program, const lang::CompileOptions& options) {
  Sink sink;
  program.compilation = lang::compile(program.source, sink, options);
  program.messages = sink.sorted();
  program.has_errors = sink.has_errors();
}

/// The evaluation alone: the others of its statement stay.
void leave_out_evaluation(lang::Compilation& compilation, const Impossible& found) {
  plan::Plan& plan = compilation.plan;
  plan::Operation& operation = plan.operations[static_cast<std::size_t>(found.operation)];
  const plan::CharacteristicDef& lost = plan[std::get<plan::Evaluate>(operation.action).characteristic];
  std::vector<std::string> features;
  for (const plan::FeatureId f : lost.features) features.push_back(plan[f].label);
  compilation.lost.push_back({lost.line, fmt::format("{}", fmt::join(features, ", ")),
                              fmt::format("TA({}): {}", plan[lost.tolerance].label, found.reason)});
  operation.action = plan::Jump{found.operation + 1};
}

}  // namespace

std::vector<Diagnostic> leave_out_what_is_impossible(CompiledProgram& program, lang::CompileOptions options,
                                                     const StudyInputs& in) {
  RunOptions run;
  run.workpiece = in.workpiece ? &*in.workpiece : nullptr;
  run.recorded = in.recording ? &*in.recording : nullptr;
  const auto next = [&] { return first_impossible(program.compilation.plan, in.machine, run, program.source); };
  while (const auto found = next()) {
    const plan::Operation& operation = program.compilation.plan.operations[static_cast<std::size_t>(found->operation)];
    if (std::holds_alternative<plan::Evaluate>(operation.action)) {
      leave_out_evaluation(program.compilation, *found);
    } else {
      // A word of control cannot be left out: the run itself then says what stops it.
      if (!options.impossible.emplace(operation.span.begin, found->reason).second) break;
      compile_again(program, options);
    }
  }
  std::vector<Diagnostic> messages;
  for (const Diagnostic& d : program.messages)
    if (d.code == Code::E0304) messages.push_back(d);
  return messages;
}

Study study_program(const CompiledProgram& program, const StudySettings& settings, const StudyInputs& in,
                    const Progress& progress) {
  const lang::Directives& asked = program.compilation.directives;
  const plan::Plan& plan = program.compilation.plan;

  StudyOptions options;
  options.workpiece = in.workpiece ? &*in.workpiece : nullptr;
  options.recorded = in.recording ? &*in.recording : nullptr;
  options.seed = settings.seed.value_or(asked.seed.value_or(options.seed));
  options.machines = settings.machines.value_or(asked.machines.value_or(kDefaultMachines));
  options.digits = settings.digits;
  options.budget = settings.budget;
  options.coverage = settings.coverage;
  options.effect_use = settings.effect_use;
  options.threads = thread_count(settings.threads);

  std::vector<Diagnostic> messages = program.messages;
  if (in.recording)
    for (Diagnostic& warning : check_recorded_points(*in.recording, program, in.machine, *settings.recording))
      messages.push_back(std::move(warning));
  for (Diagnostic& warning : machine_warnings(in.machine)) messages.push_back(std::move(warning));
  messages.insert(messages.end(), in.messages.begin(), in.messages.end());
  const Placement placement = placement_of(program, in.machine);
  options.placement_mm = placement.shift_mm;
  if (placement.message) messages.push_back(*placement.message);

  Study study = run_study(plan, in.machine, options, program.source, progress);
  study.report.version = ABBE_VERSION;
  std::vector<LostCharacteristic> lost;
  for (const lang::Lost& l : program.compilation.lost) lost.push_back({l.line, l.feature, l.reason});
  study.report.lost.insert(study.report.lost.begin(), lost.begin(), lost.end());
  study.report.messages.insert(study.report.messages.begin(), messages.begin(), messages.end());
  return study;
}

}  // namespace abbe
