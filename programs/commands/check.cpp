// abbe check PATH...: every message about the programs, and on request their plans. Only the
// error-free machine runs them, on the machine that the program names. Where it names none, the default
// machine shows what no machine can do.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "engine/base/diagnostic.hpp"
#include "engine/run/check_plan.hpp"
#include "programs/commands/commands.hpp"
#include "programs/program_files.hpp"
#include "programs/terminal.hpp"

namespace abbe {
namespace {

void add_at(const UserError& error, const SourceFile& source, Span directive, Sink& sink) {
  for (const Diagnostic& d : placed(error, source, directive)) sink.add(d);
}

/// What an error-free machine cannot do, whatever the machine is: travels and sensors are those of the
/// machine that the command line will name.
void check_on_any_machine(const CompiledProgram& program, const RunOptions& options, Sink& sink) {
  try {
    for (const Diagnostic& d :
         check_plan(program.compilation.plan, read_machine(kDefaultMachine), options, program.source))
      if (d.code != Code::W0309) sink.add(d);
  } catch (const UserError& error) {
    for (const Diagnostic& d : error.diagnostics())
      if (d.code == Code::E0304) sink.add(d);
  }
}

/// What a run would refuse on the machine and of the workpiece that the program names.
void check_on_machine(const CompiledProgram& program, Sink& sink) {
  const lang::Directives& asked = program.compilation.directives;
  const plan::Plan& plan = program.compilation.plan;
  std::optional<Workpiece> workpiece;
  try {
    workpiece = workpiece_of(program, std::nullopt);
  } catch (const UserError& error) {
    return add_at(error, program.source, asked.workpiece_span, sink);
  }
  RunOptions options;
  options.workpiece = workpiece ? &*workpiece : nullptr;
  if (!asked.machine) return check_on_any_machine(program, options, sink);
  try {
    const Machine machine = read_machine(machine_name(program, std::nullopt));
    for (const Diagnostic& d : machine_warnings(machine))
      sink.add(diagnostic_at(program.source, asked.machine_span, d.code, d.message, d.help));
    const Placement found = placement_of(program, machine);
    if (found.message) sink.add(*found.message);
    options.placement_mm = found.shift_mm;
    for (const Diagnostic& d : check_plan(plan, machine, options, program.source)) sink.add(d);
  } catch (const UserError& error) {
    add_at(error, program.source, asked.machine_span, sink);
  }
}

struct Checked {
  std::vector<Diagnostic> messages;  ///< by place
  plan::Plan plan;
};

Checked check(const std::string& path, const std::map<std::string, std::string>& answers) {
  CompiledProgram program = compile_program(path, {answers});
  Sink sink;
  for (const Diagnostic& d : program.messages) sink.add(d);
  if (!program.has_errors) check_on_machine(program, sink);
  return {sink.list(), std::move(program.compilation.plan)};
}

nlohmann::ordered_json to_json(const Diagnostic& d) {
  return {{"code", info(d.code).name}, {"severity", name(d.severity())}, {"file", d.file}, {"line", d.place.line},
          {"column", d.place.column},  {"message", d.message},           {"help", d.help}};
}

/// Names and labels keep the bytes of the file, which need not be UTF-8; JSON must be.
std::string indented(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

int check_command(const CheckOptions& options) {
  const bool as_json = options.format == "json";
  const std::vector<std::string> programs = some_program_files(options.paths);
  nlohmann::ordered_json messages = nlohmann::ordered_json::array(), plans = nlohmann::ordered_json::object();
  std::size_t errors = 0, warnings = 0;
  std::string result;
  for (const std::string& program : programs) {
    const Checked checked = check(program, options.answers);
    for (const Diagnostic& d : checked.messages) {
      errors += d.severity() == Severity::error ? 1 : 0;
      warnings += d.severity() == Severity::warning ? 1 : 0;
      if (as_json)
        messages.push_back(to_json(d));
      else
        print_messages({d});
    }
    if (!options.plan) continue;
    if (as_json)
      plans[program] = plan::to_text(checked.plan);
    else
      result += plan::to_text(checked.plan);
  }
  if (as_json) {
    nlohmann::ordered_json out = {{"schema", "abbe.check/1"}, {"messages", messages}};
    if (options.plan) out["plans"] = plans;
    result = indented(out) + "\n";
  } else {
    result += fmt::format("{}, {} in {}\n", counted(errors, "error"), counted(warnings, "warning"),
                          counted(programs.size(), "program"));
  }
  print_result(result);
  return errors > 0 ? kNo : kDone;
}

}  // namespace abbe
