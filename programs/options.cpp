#include "programs/options.hpp"

#include <CLI/CLI.hpp>
#include <charconv>
#include <memory>

#include "engine/report/writer.hpp"
#include "programs/commands/commands.hpp"
#include "programs/terminal.hpp"

namespace abbe {

namespace {

/// The command that was chosen; set by the callback of its parser.
using Chosen = std::function<int()>;

/// A struct of options that lives as long as the command that uses it.
template <class Options>
std::shared_ptr<Options> chosen_by(CLI::App* command, Chosen& chosen, int (*run)(const Options&)) {
  auto options = std::make_shared<Options>();
  command->callback([options, run, &chosen] { chosen = [options, run] { return run(*options); }; });
  return options;
}

void add_settings(CLI::App* command, StudySettings& s) {
  command->add_option("--machines", s.machines, "how many virtual machines (default 1000)")->type_name("N");
  command->add_option("--seed", s.seed, "of the random numbers (default 1)")->type_name("S");
  command->add_option("--threads", s.threads, "default: all of the computer; the result does not depend on it")->type_name("T");
}

void add_format(CLI::App* command, std::string& format, std::vector<std::string> names) {
  command->add_option("--format", format, "of the result on stdout")->check(CLI::IsMember(std::move(names)))->capture_default_str();
}

void add_run(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("run", "run a program on virtual machines and report uncertainties");
  const auto o = chosen_by(command, chosen, run_command);
  StudySettings& settings = o->request.settings;
  command->add_option("PROGRAM", o->request.program, "a DMIS program")->required();
  command->add_option("--machine", settings.machine, "machine file, or name of a shipped machine (default coord3-mc16)")->type_name("M");
  add_settings(command, settings);
  command->add_option("--digits", settings.digits, "go on until u is stable to 1 or 2 significant digits (JCGM 101, 7.9)")
      ->type_name("D")
      ->excludes("--machines");
  command->add_flag("--only-valid", o->request.only_valid, "leave out statements with errors, and say what is lost");
  std::vector<std::string> formats;
  for (const ReportWriter* writer : report_writers()) formats.emplace_back(writer->name);
  add_format(command, o->format, formats);
  command->add_option("--csv", o->csv, "write every value of every machine to this file")->type_name("C.csv");
}

void add_check(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("check", "read programs and list every message");
  const auto o = chosen_by(command, chosen, check_command);
  command->add_option("PROGRAM", o->programs, "DMIS programs")->required();
  command->add_flag("--plan", o->plan, "also print what each program was compiled to");
  add_format(command, o->format, {"text", "json"});
}

void add_test(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("test", "run programs and check their `$$! expect` lines");
  const auto o = chosen_by(command, chosen, test_command);
  command->add_option("PATH", o->paths, "programs, and folders to search for .dmi files")->required();
  command->add_option("--junit", o->junit, "write the results as JUnit XML to this file")->type_name("J.xml");
  add_settings(command, o->settings);
}

/// "i,j,k".
std::array<double, 3> parse_vector(const std::string& text) {
  std::array<double, 3> v{};
  const char *at = text.data(), *end = at + text.size();
  for (int i = 0; i < 3; ++i) {
    if (i > 0 && (at == end || *at++ != ',')) throw CLI::ConversionError(text, "--normal");
    if (at != end && *at == '+') ++at;
    const auto [next, error] = std::from_chars(at, end, v[i]);
    if (error != std::errc{}) throw CLI::ConversionError(text, "--normal");
    at = next;
  }
  if (at != end) throw CLI::ConversionError(text, "--normal");
  return v;
}

void add_fit(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("fit", "fit an element to points by least squares");
  const auto o = chosen_by(command, chosen, fit_command);
  command->add_option("ELEMENT", o->element, "line, plane, circle, sphere, cylinder, cone or torus")->required();
  command->add_option("POINTS", o->points, "CSV file with the header x,y,z")->required();
  command->add_option_function<std::string>("--normal", [o](const std::string& text) { o->normal = parse_vector(text); },
                                            "plane of a circle")->type_name("i,j,k");
  add_format(command, o->format, {"text", "json"});
}

void add_machine_action(CLI::App* machine, Chosen& chosen, const char* action, const char* help, const char* operand) {
  CLI::App* command = machine->add_subcommand(action, help);
  const auto o = chosen_by(command, chosen, machine_command);
  o->action = action;
  if (operand) command->add_option(operand, o->machine, "machine file or name")->required();
  if (o->action == "screen") {
    command->add_option("--machines", o->machines, "how many accepted machines to draw")->capture_default_str();
    command->add_option("--seed", o->seed, "of the random numbers")->capture_default_str();
    command->add_option("--threads", o->threads, "default: all of the computer")->type_name("T");
  }
  if (o->action != "init") add_format(command, o->format, {"text", "json"});
}

void add_machine(CLI::App& app, Chosen& chosen) {
  CLI::App* machine = app.add_subcommand("machine", "list, show, screen or begin machine files");
  machine->require_subcommand(1);
  add_machine_action(machine, chosen, "list", "the shipped machines", nullptr);
  add_machine_action(machine, chosen, "show", "what a machine file says, with all defaults", "MACHINE");
  add_machine_action(machine, chosen, "screen", "how many virtual machines satisfy the specification", "MACHINE");
  add_machine_action(machine, chosen, "init", "write a machine file to start from", "NAME");
}

void add_explain(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("explain", "help for a DMIS word, an effect or a message code");
  const auto o = chosen_by(command, chosen, explain_command);
  command->add_option("WORD", o->word, "for example PTMEAS, E0101; none: what there is");
  command->add_flag("--markdown", o->markdown, "the whole reference as Markdown");
}

/// The command whose options were being read when an error struck, and its name as typed: "abbe machine screen".
std::pair<const CLI::App*, std::string> innermost(const CLI::App& app) {
  const CLI::App* at = &app;
  std::string typed = "abbe";
  for (auto below = at->get_subcommands(); !below.empty(); below = at->get_subcommands()) {
    at = below.back();
    typed += " " + at->get_name();
  }
  return {at, typed};
}

std::vector<std::string> words_known_to(const CLI::App& app) {
  std::vector<std::string> words;
  for (const CLI::App* command : app.get_subcommands({})) words.push_back(command->get_name());
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
  return words;
}

UserError usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const auto [command, typed] = innermost(app);
  const std::string see = "see `" + typed + " --help`";
  const std::vector<std::string> extra = app.remaining(true);
  if (extra.empty()) return UserError(diagnostic(Code::E0609, error.what(), see));
  const std::vector<std::string> words = words_known_to(*command);
  const std::string near = nearest_word(extra.front(), {words.begin(), words.end()});
  const char* kind = extra.front().starts_with('-') ? "option" : words.empty() || command->get_subcommands({}).empty() ? "argument" : "command";
  return UserError(diagnostic(Code::E0609, "'" + typed + "' has no " + kind + " '" + extra.front() + "'",
                              near.empty() ? see : "did you mean '" + near + "'? otherwise " + see));
}

}  // namespace

std::function<int()> parse_command_line(int argc, const char* const* argv) {
  CLI::App app("Abbe: task-specific uncertainty of coordinate measurements by virtual CMMs", "abbe");
  app.set_version_flag("--version", "abbe " ABBE_VERSION);
  app.require_subcommand(1);
  Chosen chosen;
  for (const auto add : {add_run, add_check, add_test, add_fit, add_machine, add_explain}) add(app, chosen);
  const auto print = [](const std::string& text) {
    return [text] {
      print_result(text);
      return kDone;
    };
  };
  try {
    app.parse(argc, argv);
    return chosen;
  } catch (const CLI::CallForVersion& version) {
    return print(std::string(version.what()) + "\n");
  } catch (const CLI::CallForHelp&) {
    return print(innermost(app).first->help());
  } catch (const CLI::ParseError& error) {
    throw usage_error(app, error);
  }
}

}  // namespace abbe
