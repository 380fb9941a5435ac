// `abbe run`: a program on many virtual machines, and the uncertainty of everything that it
// evaluates.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "engine/base/files.hpp"
#include "engine/report/dmis_result.hpp"
#include "engine/report/writer.hpp"
#include "programs/commands/commands.hpp"
#include "programs/terminal.hpp"

namespace abbe {

namespace {

void refuse_errors(const CompiledProgram& program) {
  const auto errors = std::count_if(program.messages.begin(), program.messages.end(),
                                    [](const Diagnostic& d) { return d.severity() == Severity::error; });
  throw UserError(diagnostic(
      Code::E0604,
      fmt::format("'{}' has {} error{} and was not run", program.source.name(), errors, errors == 1 ? "" : "s"),
      "correct the program, or leave those statements out with --only-valid"));
}

}  // namespace

int run_command(const RunCommandOptions& options) {
  const ReportWriter* writer = find_report_writer(options.format);
  const lang::CompileOptions as_asked{options.request.answers, options.request.only_valid};
  CompiledProgram program = compile_program(options.request.program, as_asked);
  std::set<std::string> told;  // the report repeats what was said when the program was read
  const auto tell = [&](const std::vector<Diagnostic>& messages) {
    for (const Diagnostic& d : messages)
      if (told.insert(render(d)).second) print_messages({d});
  };
  tell(program.messages);
  if (program.has_errors && !options.request.only_valid) refuse_errors(program);
  const StudyInputs inputs = read_inputs(program, options.request.settings);
  const std::vector<std::string> outputs = files_given({options.report, options.csv, options.dmo});
  refuse_overwriting(inputs.files, outputs);
  if (options.format != "text") refuse_stdout(outputs);
  if (options.request.only_valid) tell(leave_out_what_is_impossible(program, as_asked, inputs));

  ProgressLine line;
  const Study study =
      study_program(program, options.request.settings, inputs, [&](std::string_view step) { line.show(step); });
  const plan::Plan& plan = program.compilation.plan;
  std::vector<OutputFile> files;
  if (options.csv) files.push_back({*options.csv, samples_csv(plan, study)});
  if (options.dmo)
    files.push_back({*options.dmo, dmis_result(plan, study.result.reference_outputs, study.report.characteristics)});
  if (options.report) files.push_back({*options.report, find_report_writer("html")->write(study.report)});
  tell(study.report.messages);
  print_result(writer->write(study.report), files);
  return kDone;
}

}  // namespace abbe
