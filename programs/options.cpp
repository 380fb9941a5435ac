#include "programs/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <type_traits>

#include "engine/base/letter_case.hpp"
#include "engine/base/numbers.hpp"
#include "engine/report/writer.hpp"
#include "programs/commands/commands.hpp"
#include "programs/terminal.hpp"
#include "programs/thread_count.hpp"

namespace abbe {

namespace {

constexpr int kMostRepeats = 1'000'000;

/// The command that was chosen; set by the callback of its parser.
using Chosen = std::function<int()>;

/// A struct of options that lives as long as the command that uses it.
template <class Options>
std::shared_ptr<Options> chosen_by(CLI::App* command, Chosen& chosen, int (*run)(const Options&)) {
  auto options = std::make_shared<Options>();
  command->callback([options, run, &chosen] { chosen = [options, run] { return run(*options); }; });
  return options;
}

template <class Value>
struct NumberOf {
  using Type = Value;
};
template <class Value>
struct NumberOf<std::optional<Value>> {
  using Type = Value;
};

/// The numbers that an option takes. What lies beyond is for the command to refuse, which knows why; `strict`: no command
/// does.
template <class Number>
struct Range {
  Number least, most;
  bool strict = false;
};

/// A number in decimals, as the directives of a program have it, and nothing else: CLI11 would read 010 as 8
/// and 0x64 as 100, and make the largest number of what is too large.
template <class Number>
Number decimal(const std::string& option, const std::string& text, const Range<Number>& range) {
  const char *begin = text.data(), *end = begin + text.size();
  if (begin != end && *begin == '+') ++begin;
  Number value{};
  const auto [stop, error] = std::from_chars(begin, end, value);
  const bool inside = value >= range.least && value <= range.most;
  const bool number = error == std::errc{} && stop == end && std::isfinite(static_cast<double>(value));
  if (number && (inside || !range.strict)) return value;
  const char* const kind = std::is_integral_v<Number> ? "a whole number" : "a number with a decimal point";
  throw CLI::ValidationError(option,
                             fmt::format("expected {} from {} to {}, found {}", kind, range.least, range.most, text));
}

/// An option that takes a number.
template <class Value, class Number = typename NumberOf<Value>::Type>
CLI::Option* add_number(CLI::App* command, const std::string& option, Value& value, Range<Number> range,
                        const std::string& help) {
  return command->add_option_function<std::string>(
      option, [&value, option, range](const std::string& text) { value = decimal<Number>(option, text, range); }, help);
}

/// What holds without an option that a directive of the program may set.
std::string else_of_program(const std::string& otherwise) {
  return " (default: what the program says, else " + otherwise + ")";
}

template <class Value>
void add_seed(CLI::App* command, Value& seed, const std::string& help) {
  add_number(command, "--seed", seed, {0, std::numeric_limits<std::uint64_t>::max()}, help)->type_name("S");
}

template <class Value>
void add_machines(CLI::App* command, Value& machines, int least, const std::string& help) {
  add_number(command, "--machines", machines, {least, std::numeric_limits<int>::max()}, help)->type_name("N");
}

void add_machine_of_program(CLI::App* command, std::optional<std::string>& machine) {
  command
      ->add_option("--machine", machine,
                   "machine file, or name of a shipped machine" + else_of_program(std::string(kDefaultMachine)))
      ->type_name("M");
}

void add_workpiece_of_program(CLI::App* command, std::optional<std::string>& workpiece) {
  command
      ->add_option("--workpiece", workpiece,
                   "workpiece file: true sizes, temperatures and form of the part" + else_of_program("none"))
      ->type_name("W.json");
}

void add_threads(CLI::App* command, int& threads) {
  add_number(
      command, "--threads", threads, {0, kMostThreads},
      fmt::format("1 to {}; 0, the default: all of the computer; the result does not depend on it", kMostThreads))
      ->type_name("T");
}

void add_settings(CLI::App* command, StudySettings& s) {
  add_workpiece_of_program(command, s.workpiece);
  add_machines(command, s.machines, 2, "how many virtual machines" + else_of_program("1000"));
  add_seed(command, s.seed, "of the random numbers" + else_of_program("1"));
  add_threads(command, s.threads);
}

void add_format(CLI::App* command, std::string& format, std::vector<std::string> names) {
  command->add_option("--format", format, "of the result on stdout")
      ->check(CLI::IsMember(std::move(names)))
      ->capture_default_str();
}

/// The effects of the machine file, as GUM F.2.4.5 or as GUM 3.2.4 wants them.
void add_effects(CLI::App* command, EffectUse& use) {
  const auto take = [&use](const std::string& word) {
    use = word == name(EffectUse::corrected) ? EffectUse::corrected : EffectUse::left_in;
  };
  command
      ->add_option_function<std::string>(
          "--effects", take,
          "of the machine file: left-in (an error of every result; default) or corrected (only their uncertainty)")
      ->check(CLI::IsMember({std::string(name(EffectUse::left_in)), std::string(name(EffectUse::corrected))}));
}

/// What the operator would say.
void add_answers(CLI::App* command, std::map<std::string, std::string>& answers) {
  const auto take = [&answers](const std::vector<std::string>& list) {
    for (const std::string& text : list) {
      const std::size_t equals = text.find('=');
      if (equals == std::string::npos || equals == 0)
        throw CLI::ConversionError(text, "--answer: expected NAME=VALUE, as in --answer SERIAL=12");
      const std::string name = upper(text.substr(0, equals));
      if (!answers.emplace(name, text.substr(equals + 1)).second)
        throw CLI::ConversionError(text, fmt::format("--answer: {} has an answer already", name));
    }
  };
  command
      ->add_option_function<std::vector<std::string>>("--answer", take,
                                                      "answer to a PROMPT of the program (may be repeated)")
      ->type_name("NAME=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_run(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("run", "run a program on virtual machines and report uncertainties");
  const auto o = chosen_by(command, chosen, run_command);
  StudySettings& settings = o->request.settings;
  command->add_option("PROGRAM", o->request.program, "a DMIS program")->required();
  add_machine_of_program(command, settings.machine);
  add_settings(command, settings);
  add_number(command, "--digits", settings.digits, {1, 2},
             "go on until u is stable to 1 or 2 significant digits (JCGM 101, 7.9)")
      ->type_name("D")
      ->excludes("--machines");
  command
      ->add_option("--recording", settings.recording,
                   "add the errors to these recorded points instead of to nominal ones")
      ->type_name("REC.csv");
  add_effects(command, settings.effect_use);
  command->add_flag("--budget", settings.budget,
                    "share out the variance among all sources, and between alignment and features");
  add_number(command, "--coverage", settings.coverage, {0, 1},
             "also report the intervals of this coverage probability (LCL and UCL stay those of 0.95)")
      ->type_name("P");
  add_answers(command, o->request.answers);
  command->add_flag("--only-valid", o->request.only_valid, "leave out statements with errors, and say what is lost");
  std::vector<std::string> formats;
  for (const ReportWriter* writer : report_writers()) formats.emplace_back(writer->name);
  add_format(command, o->format, formats);
  command->add_option("--report", o->report, "write a page with the distributions to this file")->type_name("R.html");
  command->add_option("--csv", o->csv, "write every value of every machine to this file")->type_name("C.csv");
  command->add_option("--dmo", o->dmo, "write the DMIS result file of the error-free machine")->type_name("D.dmo");
}

void add_check(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("check", "read programs and list every message");
  const auto o = chosen_by(command, chosen, check_command);
  command->add_option("PATH", o->paths, "programs, and folders to search for .dmi files")->required();
  add_answers(command, o->answers);
  command->add_flag("--plan", o->plan, "also print what each program was compiled to");
  add_format(command, o->format, {"text", "json"});
}

void add_test(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("test", "run programs and check their `$$! expect` lines");
  const auto o = chosen_by(command, chosen, test_command);
  command->add_option("PATH", o->paths, "programs, and folders to search for .dmi files")->required();
  command->add_option("--junit", o->junit, "write the results as JUnit XML to this file")->type_name("J.xml");
  add_settings(command, o->settings);
  add_answers(command, o->answers);
}

/// "i,j,k".
std::array<double, 3> parse_vector(const std::string& text) {
  std::array<double, 3> v{};
  std::string_view rest = text;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::optional<double> number = finite_number(rest.substr(0, comma));
    const bool last = comma == rest.size();
    if (!number || last != (i + 1 == v.size())) throw CLI::ConversionError(text, "--normal");
    v[i] = *number;
    if (!last) rest.remove_prefix(comma + 1);
  }
  return v;
}

void add_fit(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("fit", "fit an element to points by least squares");
  const auto o = chosen_by(command, chosen, fit_command);
  const std::vector<std::string_view> elements = fit_elements();
  const std::string help =
      fmt::format("{} or {}", fmt::join(elements.begin(), elements.end() - 1, ", "), elements.back());
  command->add_option("ELEMENT", o->element, help)->required();
  command->add_option("POINTS", o->points, "CSV file with the header x,y,z")->required();
  command
      ->add_option_function<std::string>(
          "--normal", [o](const std::string& text) { o->normal = parse_vector(text); }, "plane of a circle")
      ->type_name("i,j,k");
  add_format(command, o->format, {"text", "json"});
}

void add_machine_action(CLI::App* machine, Chosen& chosen, const char* action, const char* help, const char* operand) {
  CLI::App* command = machine->add_subcommand(action, help);
  const auto o = chosen_by(command, chosen, machine_command);
  o->action = action;
  if (operand)
    command->add_option(operand, o->machine, o->action == "init" ? "of the new machine" : "machine file or name")
        ->required();
  if (o->action == "screen") {
    add_machines(command, o->machines, 1, "how many accepted machines to draw (default 1000)");
    add_threads(command, o->threads);
  }
  if (o->action == "screen" || o->action == "show") add_seed(command, o->seed, "of the random numbers (default 1)");
  if (o->action != "init") add_format(command, o->format, {"text", "json"});
}

void add_machine(CLI::App& app, Chosen& chosen) {
  CLI::App* machine = app.add_subcommand("machine", "list, show, screen or begin machine files");
  machine->require_subcommand(1);
  add_machine_action(machine, chosen, "list", "the shipped machines", nullptr);
  add_machine_action(machine, chosen, "show",
                     "what a machine file says, with all defaults, and one virtual machine of it", "MACHINE");
  add_machine_action(machine, chosen, "screen", "how many virtual machines satisfy the specification", "MACHINE");
  add_machine_action(machine, chosen, "init", "a machine file to start from: NAME prints it, NAME.json writes it",
                     "NAME");
}

void add_record(CLI::App& app, Chosen& chosen) {
  CLI::App* command =
      app.add_subcommand("record", "run a program on one virtual machine and write what it reports, touch by touch");
  const auto o = chosen_by(command, chosen, record_command);
  command->add_option("PROGRAM", o->program, "a DMIS program")->required();
  add_machine_of_program(command, o->machine);
  add_workpiece_of_program(command, o->workpiece);
  command
      ->add_option("--with", o->with,
                   "let an effect act, left in: EFFECT or EFFECT:parameter=value,... (may be repeated)")
      ->type_name("EFFECT")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  add_seed(command, o->seed, "chooses the machine and its noise" + else_of_program("1"));
  add_number(command, "--run", o->run, {1, kMostRepeats, true},
             "which repeat: the same machine and part, other noise of probe and head (default 1)")
      ->type_name("K");
  add_number(
      command, "--setup", o->setup, {1, kMostRepeats, true},
      "which placement of the part, with other noise: a diagnosis takes those of other setups as placed anew (default 1)")
      ->type_name("N");
  add_answers(command, o->answers);
  command->add_option("-o,--output", o->output, "the CSV file to write")->required()->type_name("REC.csv");
  command->add_option("--dmo", o->dmo, "write the DMIS result file of the recorded machine")->type_name("D.dmo");
}

void add_diagnose(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand(
      "diagnose", "say where recordings differ from the simulation, and which physics would explain it");
  const auto o = chosen_by(command, chosen, diagnose_command);
  command
      ->add_option("REC", o->recordings,
                   "recordings, CSV; several are taken as one; or a file of values: CSV, or a DMIS result file")
      ->required();
  command
      ->add_option("--program", o->program,
                   "the program that was run: for recordings without targets or in part coordinates, and for values")
      ->type_name("P.dmi");
  command
      ->add_option(
          "--machine", o->machine,
          "machine file, or name of a shipped machine (default: what the recording says, else the program, else "
          "coord3-mc16)")
      ->type_name("M");
  add_workpiece_of_program(command, o->workpiece);
  command
      ->add_option(
          "--known", o->known,
          "machine file that an earlier diagnosis wrote: start from what is known of the machine (counts before --machine)")
      ->type_name("K.json");
  command->add_option("--report", o->report, "write the diagnosis as a page with figures, one HTML file")
      ->type_name("R.html");
  CLI::Option* model_out =
      command->add_option("--model-out", o->model_out, "write the machine file with what was found in it")
          ->type_name("I.json");
  CLI::Option* fail =
      command->add_flag("--fail-on-mismatch", o->fail_on_mismatch, "exit with 1 when there is a mismatch");
  command
      ->add_flag("--design-only", o->design_only, "say what such a recording could tell, without looking at its values")
      ->excludes(model_out)
      ->excludes(fail);
  add_seed(command, o->seed, "of the simulated recordings (default 1)");
  add_threads(command, o->threads);
  add_format(command, o->format, {"text", "json"});
}

void add_format_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("format", "write programs in one style, without changing what they mean");
  const auto o = chosen_by(command, chosen, format_command);
  command->add_option("PATH", o->paths, "programs, and folders to search for .dmi files")->required();
  CLI::Option* check = command->add_flag("--check", o->check, "only list the programs that are not in that style");
  command->add_flag("--write", o->write, "write the programs back instead of to stdout")->excludes(check);
}

void add_lsp(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("lsp", "language server for editors, on stdin and stdout");
  command->callback([&chosen] { chosen = lsp_command; });
  command->add_flag("--stdio")->description("speak on stdin and stdout (the only way)");
}

void add_repl(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("repl", "enter statements one at a time and see their results");
  const auto o = chosen_by(command, chosen, repl_command);
  command->add_option("PROGRAM", o->program, "a DMIS program to begin with");
  add_machine_of_program(command, o->settings.machine);
  add_settings(command, o->settings);
}

void add_explain(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("explain", "help for a DMIS word, an effect or a message code");
  const auto o = chosen_by(command, chosen, explain_command);
  CLI::Option* word = command->add_option("WORD", o->word, "for example PTMEAS, E0101; none: what there is");
  add_format(command, o->format, {"text", "vega"});
  command->add_flag("--markdown", o->markdown, "the whole reference as Markdown")
      ->excludes(word)
      ->excludes(command->get_option("--format"));
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

std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> words_known_to(const CLI::App& app) {
  std::vector<std::string> words = commands_of(app);
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
  return words;
}

UserError usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const auto [command, typed] = innermost(app);
  const std::string see = "see `" + typed + " --help`";
  const std::vector<std::string> commands = commands_of(*command), extra = app.remaining(true);
  if (extra.empty()) {
    const std::string needs = fmt::format("'{}' needs one of these commands: {}", typed, fmt::join(commands, ", "));
    return UserError(diagnostic(Code::E0609, commands.empty() ? error.what() : needs, see));
  }
  const std::string& word = extra.front();
  const std::vector<std::string> words = words_known_to(*command);
  const std::string near = nearest_word(word, {words.begin(), words.end()});
  const char* kind = word.starts_with('-') ? "option" : commands.empty() ? "further argument" : "command";
  return UserError(diagnostic(Code::E0609, fmt::format("'{}' has no {} '{}'", typed, kind, word),
                              near.empty() ? see : fmt::format("did you mean '{}'? otherwise {}", near, see)));
}

}  // namespace

std::function<int()> parse_command_line(int argc, const char* const* argv) {
  CLI::App app("Abbe: task-specific uncertainty of coordinate measurements by virtual CMMs", "abbe");
  app.set_version_flag("--version", "abbe " ABBE_VERSION);
  app.require_subcommand(1);
  Chosen chosen;
  for (const auto add : {add_run, add_check, add_test, add_fit, add_machine, add_record, add_diagnose,
                         add_format_command, add_lsp, add_repl, add_explain})
    add(app, chosen);
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
    return print(app.help());
  } catch (const CLI::ParseError& error) {
    throw usage_error(app, error);
  }
}

}  // namespace abbe
