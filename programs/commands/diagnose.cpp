// `abbe diagnose`: do recordings agree with the machine, and if not, what was left out?
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <thread>

#include "engine/base/files.hpp"
#include "engine/report/diagnosis/diagnosis_report.hpp"
#include "engine/run/placement.hpp"
#include "engine/run/recorded_sensor.hpp"
#include "engine/run/recorded_touch.hpp"
#include "programs/commands/commands.hpp"
#include "programs/terminal.hpp"

namespace abbe {

namespace {

/// What an error-free machine would record of the program: targets, normals, sensors.
Recording nominal_recording(const std::string& path, const Machine& machine) {
  const CompiledProgram program = compile_program(path);
  print_messages(program.messages);
  if (program.has_errors)
    throw UserError(diagnostic(Code::E0604, fmt::format("'{}' has errors and was not run", program.source.name()), "correct the program; `abbe check` lists what is wrong"));
  RunOptions run;
  run.contributors = {.geometry = false, .head = false, .probe = false, .only_component = {}, .part = false, .effects = false, .only_effect = {}};
  const plan::Plan& plan = program.compilation.plan;
  run.placement_mm = program.compilation.directives.place_mm ? *program.compilation.directives.place_mm : find_placement(plan, machine, program.source).shift_mm;
  return record_plan(plan, machine, screened_machines(machine, 1, 1, 1), run, program.source).recording;
}

/// Several files are one recording; their frames must agree.
Recording joined(const std::vector<std::string>& files) {
  Recording all;
  for (std::size_t k = 0; k < files.size(); ++k) {
    Recording one = read_recording(read_source(files[k]));
    if (k == 0) {
      all = std::move(one);
      continue;
    }
    if (one.in_part_frame != all.in_part_frame || one.point != all.point)
      throw UserError(diagnostic(Code::E0707, fmt::format("'{}' and '{}' have different frames or points", files[0], files[k]),
                                 "the lines '# frame:' and '# point:' must say the same in all files"));
    all.rows.insert(all.rows.end(), one.rows.begin(), one.rows.end());
  }
  return all;
}

}  // namespace

int diagnose_command(const DiagnoseCommandOptions& options) {
  Recording recording = joined(options.recordings);
  const std::string file = fmt::format("{}", fmt::join(options.recordings, ", "));
  std::string name = options.machine.value_or("");
  for (const auto& [key, value] : recording.metadata)
    if (name.empty() && key == "machine") name = value;
  if (name.empty()) name = kDefaultMachine;
  Machine machine = read_machine(options.known.value_or(name));
  if (options.program) complete_from_program(recording, nominal_recording(*options.program, machine), file);
  add_recorded_sensors(recording, machine, file);

  DiagnoseOptions how;
  how.seed = options.seed.value_or(1);
  how.threads = options.threads > 0 ? options.threads : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  how.design_only = options.design_only;
  how.keep_state = options.model_out.has_value();
  const Diagnosis d = diagnose_recording(recording, machine, how, file);
  print_messages(d.messages);
  if (options.model_out) write_whole(*options.model_out, improved_machine(machine_text(options.known.value_or(name)), d));
  print_result(options.format == "json" ? diagnosis_json(d) : diagnosis_text(d));
  return options.fail_on_mismatch && d.verdict != Verdict::no_mismatch ? kNo : kDone;
}

}  // namespace abbe
