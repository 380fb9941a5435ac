#include "programs/program_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "engine/run/placement.hpp"
#include "programs/thread_count.hpp"

namespace abbe {

namespace {

/// A file that a directive names: its path is as seen from the program.
std::string beside(const CompiledProgram& program, const std::string& path) {
  return (std::filesystem::path(program.source.name()).parent_path() / path).string();
}

}  // namespace

std::string machine_name(const CompiledProgram& program, const std::optional<std::string>& chosen) {
  if (chosen) return *chosen;
  const std::string asked = program.compilation.directives.machine.value_or(kDefaultMachine);
  const std::string file = beside(program, asked);
  return std::filesystem::exists(file) ? file : asked;
}

std::optional<Workpiece> workpiece_of(const CompiledProgram& program, const std::optional<std::string>& chosen) {
  if (chosen) return read_workpiece(*chosen);
  const std::optional<std::string>& asked = program.compilation.directives.workpiece;
  if (!asked) return std::nullopt;
  return read_workpiece(beside(program, *asked));
}

CompiledProgram compile_program(const std::string& path, const std::map<std::string, std::string>& answers) {
  Sink sink;
  SourceFile source = read_text(path, sink);
  lang::Compilation compilation = lang::compile(source, sink, {answers});
  return {std::move(source), std::move(compilation), sink.sorted(), sink.has_errors()};
}

Study study_program(const CompiledProgram& program, const StudySettings& settings, const Progress& progress) {
  const lang::Directives& asked = program.compilation.directives;
  const plan::Plan& plan = program.compilation.plan;
  const Machine machine = read_machine(machine_name(program, settings.machine));

  const std::optional<Workpiece> workpiece = workpiece_of(program, settings.workpiece);

  StudyOptions options;
  options.workpiece = workpiece ? &*workpiece : nullptr;
  Sink sink;
  const std::optional<Recording> recorded =
      settings.recording ? std::optional(read_recording(read_text(*settings.recording, sink))) : std::nullopt;
  options.recorded = recorded ? &*recorded : nullptr;
  options.seed = settings.seed.value_or(asked.seed.value_or(options.seed));
  options.machines = settings.machines.value_or(asked.machines.value_or(kDefaultMachines));
  options.digits = settings.digits;
  options.budget = settings.budget;
  options.coverage = settings.coverage;
  options.effect_use = settings.effect_use;
  options.threads = thread_count(settings.threads);

  std::vector<Diagnostic> messages = program.messages;
  messages.insert(messages.end(), sink.list().begin(), sink.list().end());
  if (asked.place_mm) {
    options.placement_mm = *asked.place_mm;
  } else {
    const Placement placement = find_placement(plan, machine, program.source);
    options.placement_mm = placement.shift_mm;
    if (placement.message) messages.push_back(*placement.message);
  }

  Study study = run_study(plan, machine, options, program.source, progress);
  study.report.version = ABBE_VERSION;
  std::vector<LostCharacteristic> lost;
  for (const lang::Lost& l : program.compilation.lost) lost.push_back({l.line, l.feature, l.reason});
  study.report.lost.insert(study.report.lost.begin(), lost.begin(), lost.end());
  study.report.messages.insert(study.report.messages.begin(), messages.begin(), messages.end());
  return study;
}

}  // namespace abbe
