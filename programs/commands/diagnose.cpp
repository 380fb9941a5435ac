// `abbe diagnose`: do recordings agree with the machine, and if not, what was left out?
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "engine/base/files.hpp"
#include "engine/report/diagnosis/diagnosis_report.hpp"
#include "engine/run/recorded/from_program.hpp"
#include "engine/run/recorded/part.hpp"
#include "engine/run/recorded/sensor_lines.hpp"
#include "engine/run/recorded/touch.hpp"
#include "programs/commands/joined_recordings.hpp"
#include "programs/commands/recorded_values.hpp"
#include "programs/commands/usable_program.hpp"
#include "programs/recorded_points.hpp"
#include "programs/terminal.hpp"
#include "programs/thread_count.hpp"

namespace abbe {

namespace {

/// What is said before the answer is there. It is printed with the answer and stands in its reports, too.
using Said = std::vector<Diagnostic>;

/// The machine to compare with: what the command line names, else the recording or its program, else the default.
template <class Recorded>
std::string machine_of(const DiagnoseCommandOptions& options, Said& said, Recorded recorded_machine) {
  if (options.known) return *options.known;
  if (options.machine) return *options.machine;
  if (const std::string recorded = recorded_machine(); !recorded.empty()) return recorded;
  said.push_back(
      diagnostic(Code::N0735,
                 fmt::format("neither command nor recording nor program names a machine: {} is taken, the default",
                             kDefaultMachine),
                 "name yours with --machine, or in a line '# machine: NAME' before the table"));
  return kDefaultMachine;
}

/// Every file is read once: it may come through a pipe.
struct Files {
  std::vector<SourceFile> recordings;
  std::optional<Workpiece> workpiece;
};

/// Before the work: a diagnosis takes minutes. `programs`: those that were compiled, with their modules.
void protect_files(const DiagnoseCommandOptions& options, const Files& read, const std::vector<std::string>& programs,
                   const std::string& machine) {
  std::vector<std::string> inputs = programs;
  inputs.push_back(machine);
  for (const std::string& file : files_of(read.workpiece)) inputs.push_back(file);
  inputs.insert(inputs.end(), options.recordings.begin(), options.recordings.end());
  const std::vector<std::string> outputs = files_given({options.report, options.model_out});
  refuse_overwriting(inputs, outputs);
  if (options.format != "text") refuse_stdout(outputs);
}

struct Answer {
  Diagnosis diagnosis;
  std::string machine;       ///< that it was compared with, as read_machine takes it
  std::string machine_text;  ///< of its file
  std::string name;          ///< of that machine
};

/// The part that was measured: the one of the command line, else that which the programs name.
void read_part(const DiagnoseCommandOptions& options, const std::vector<CompiledProgram>& programs, Files& read,
               DiagnoseOptions& how) {
  if (options.workpiece) read.workpiece = read_workpiece(*options.workpiece);
  for (const CompiledProgram& program : programs) {
    if (options.workpiece) break;
    std::optional<Workpiece> part = workpiece_of(program, std::nullopt);
    if (part && read.workpiece && part->source.name() != read.workpiece->source.name())
      throw UserError(diagnostic(Code::E0562,
                                 fmt::format("the programs name different workpiece files: '{}' and '{}'",
                                             read.workpiece->source.name(), part->source.name()),
                                 "give the file of the part that was measured with --workpiece"));
    if (part) read.workpiece = std::move(part);
  }
  how.workpiece = read.workpiece ? &*read.workpiece : nullptr;
}

Answer of_values(const DiagnoseCommandOptions& options, Files& read, DiagnoseOptions how, Said& said) {
  const RecordedValues values(read.recordings.front(), options.program, said);
  read_part(options, values.programs(), read, how);
  const std::string name = machine_of(options, said, [&] { return values.machine(); });
  protect_files(options, read, values.files(), name);
  const std::string text = machine_text(name);
  const Machine machine = parse_machine(name, text);
  if (options.known || machine.known_state)
    said.push_back(diagnostic(
        Code::W0715,
        fmt::format("values are compared with all machines of the specification: no known_state of '{}' is used", name),
        "record the touches: their diagnosis uses it"));
  return {values.diagnosis(machine, how), name, text, machine.name};
}

/// The name of the machine that --machine or else the recording names; nothing where no file of it is here.
std::optional<std::string> other_name(const DiagnoseCommandOptions& options, const Recording& recording) {
  if (options.machine) return read_machine(*options.machine).name;
  return name_of_recorded_machine(abbe::said(recording.metadata, "machine").value_or(""), options.recordings);
}

/// What is known of one machine says nothing of another.
void doubt_known(const DiagnoseCommandOptions& options, const Recording& recording, const Machine& known, Said& said) {
  if (!known.known_state)
    said.push_back(diagnostic(Code::W0715,
                              fmt::format("'{}' has no known_state: the machine counts as new", *options.known),
                              "`abbe diagnose --model-out` writes one; --machine takes a file without"));
  const std::optional<std::string> other = other_name(options, recording);
  if (other && *other != known.name)
    said.push_back(diagnostic(
        Code::W0714,
        fmt::format("'{}' knows machine '{}', {} '{}': it is compared with what is known of '{}'", *options.known,
                    known.name, options.machine ? "--machine says" : "the recording is of", *other, known.name),
        "give --known what was learned of the same machine"));
}

Answer of_touches(const DiagnoseCommandOptions& options, Files& read, DiagnoseOptions how, Said& said) {
  Recording recording =
      joined(read.recordings, options.design_only ? Positions::or_targets : Positions::recorded, said);
  const std::string file = fmt::format("{}", fmt::join(options.recordings, ", "));
  std::vector<CompiledProgram> programs;
  if (options.program) programs.push_back(usable_program(*options.program));
  const CompiledProgram* const program = programs.empty() ? nullptr : &programs.front();
  if (program) said.insert(said.end(), program->messages.begin(), program->messages.end());
  read_part(options, programs, read, how);
  const std::string name = machine_of(options, said, [&] {
    const std::string recorded =
        recorded_machine(abbe::said(recording.metadata, "machine").value_or(""), options.recordings);
    const bool program_says = program && program->compilation.directives.machine;
    return recorded.empty() && program_says ? machine_name(*program, std::nullopt) : recorded;
  });
  protect_files(options, read, program ? files_compiled(*program) : std::vector<std::string>{}, name);
  const std::string text = machine_text(name);
  Machine machine = parse_machine(name, text);
  if (options.known) doubt_known(options, recording, machine, said);
  if (program) complete_from_program(recording, nominal_record(*program, machine), file);
  if (how.workpiece) fill_from_workpiece(recording, *how.workpiece);
  add_recorded_sensors(recording, machine, file, said);
  return {diagnose_recording(recording, machine, how, file), name, text, machine.name};
}

/// Who asks for the machine file with what was found in it is told where it has none of it. What is gone it does not need.
void tell_what_is_not_carried(const std::string& model_out, Diagnosis& d) {
  const auto stays = [](const DiagnosedEffect& e) { return e.change.empty() || !e.change.front().gone(); };
  const bool found = d.unexplained || std::any_of(d.effects.begin(), d.effects.end(), stays);
  if (!found || !d.model_effects.empty() || !d.superseded.empty()) return;
  d.messages.push_back(diagnostic(
      Code::W0737, fmt::format("'{}' has nothing of what was found: no machine file can carry it", model_out),
      "the answer says why; 'abbe run' on that machine gives uncertainties without it"));
}

}  // namespace

int diagnose_command(const DiagnoseCommandOptions& options) {
  Sink sink;
  Files read;
  for (const std::string& file : options.recordings) read.recordings.push_back(read_text(file, sink));
  DiagnoseOptions how;
  how.seed = options.seed.value_or(1);
  how.threads = thread_count(options.threads);
  how.design_only = options.design_only;
  how.keep_state = options.model_out.has_value();
  Said said = sink.list();
  auto [d, machine, machine_text, name] = [&] {
    ProgressLine line;
    how.progress = [&](std::string_view step) { line.show(step); };
    try {
      return are_values(read.recordings) ? of_values(options, read, how, said) : of_touches(options, read, how, said);
    } catch (const UserError& error) {
      said.insert(said.end(), error.diagnostics().begin(), error.diagnostics().end());
      throw UserError(said);
    }
  }();
  d.messages.insert(d.messages.begin(), said.begin(), said.end());
  if (options.model_out) tell_what_is_not_carried(*options.model_out, d);
  print_messages(d.messages);
  std::vector<OutputFile> files;
  if (options.model_out) files.push_back({*options.model_out, improved_machine(machine_text, d)});
  if (options.report)
    files.push_back(
        {*options.report, diagnosis_html(d, fmt::format("{}", fmt::join(options.recordings, ", ")), machine)});
  print_result(options.format == "json" ? diagnosis_json(d, name) : diagnosis_text(d), files);
  return options.fail_on_mismatch && is_mismatch(d) ? kNo : kDone;
}

}  // namespace abbe
