// abbe repl [PROGRAM]: an interactive session.
#include "programs/commands/commands.hpp"
#include "programs/repl/line_editor.hpp"
#include "programs/repl/session.hpp"
#include "programs/terminal.hpp"
#include "programs/thread_count.hpp"

namespace abbe {

namespace {

/// What else a session would say only when it first evaluates something.
void refuse_unusable(const StudySettings& settings) {
  if (settings.machine) read_machine(*settings.machine);
  if (settings.workpiece) read_workpiece(*settings.workpiece);
  StudyOptions options;
  options.machines = settings.machines.value_or(options.machines);
  options.threads = thread_count(settings.threads);
  check_options(options);
}

}  // namespace

int repl_command(const ReplOptions& options) {
  refuse_unusable(options.settings);
  Session session(options.settings);
  LineEditor editor([&](const std::string& line) { return session.completions(line); });
  if (editor.interactive())
    print_result("Abbe: statements of DMIS one at a time; .help lists the commands, .quit ends.\n");
  if (options.program) print_result(session.load(*options.program));
  while (!session.finished()) {
    const auto line = editor.read(session.waiting() ? "  ... " : "abbe> ");
    if (!line) break;
    if (const std::string reply = line->dropped ? session.drop() : session.enter(line->text); !reply.empty())
      print_result(reply);
  }
  if (session.waiting()) print_result("the input ended inside an entry, which is dropped\n");
  return kDone;
}

}  // namespace abbe
