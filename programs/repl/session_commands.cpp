// The commands of a session: lines that begin with a dot.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>

#include "engine/base/file_kind.hpp"
#include "engine/base/files.hpp"
#include "lang/lines.hpp"
#include "lang/parser.hpp"
#include "programs/repl/session.hpp"
#include "programs/repl/standard_tasks.hpp"
#include "programs/terminal.hpp"

namespace abbe {

namespace {

/// A program without its ENDFIL, so that more can be entered.
std::string without_end(const SourceFile& source) {
  std::string text;
  Sink ignored;
  const std::vector<lang::LogicalLine> lines = lang::logical_lines(source);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto raw = lang::parse_statement(lines[i], source, ignored);
    if (raw && raw->word == "ENDFIL") continue;
    const int end = i + 1 < lines.size() ? lines[i + 1].line : source.line_count() + 1;
    for (int number = lines[i].line; number < end; ++number) text += std::string(source.line(number)) + "\n";
  }
  while (text.ends_with("\n\n")) text.pop_back();
  return text == "\n" ? "" : text;
}

/// "S(P)", "SA(P)" and "P" name the sensor P.
std::string bare_label(const std::string& operand) {
  const std::size_t open = operand.find('(');
  if (open == std::string::npos || !operand.ends_with(')')) return operand;
  return operand.substr(open + 1, operand.size() - open - 2);
}

/// A column with how many times `one` is `other`; of what never varies there is no such number.
std::string ratio(double one, double other) {
  return other > 0 ? fmt::format("{:>9.2f}", one / other) : fmt::format("{:>9}", "-");
}

[[noreturn]] void missing(const Session::Command& command, const char* what) {
  throw UserError(
      diagnostic(Code::E0613, fmt::format("{} needs {}", command.word, what), fmt::format("write {}", command.form)));
}

const Session::Command& command_named(std::string_view word) {
  const auto& all = Session::commands();
  return *std::find_if(all.begin(), all.end(), [&](const Session::Command& c) { return c.word == word; });
}

}  // namespace

const std::vector<Session::Command>& Session::commands() {
  static const std::vector<Command> table = {
      {".help", ".help", "this list", &Session::help},
      {".list", ".list", "the program so far", &Session::list},
      {".run", ".run", "evaluate everything again", &Session::run},
      {".undo", ".undo", "take the last entry back, or the one that is being typed", &Session::undo},
      {".machine", ".machine [NAME]", "the machine to use: a file, or the name of a shipped one", &Session::machine},
      {".machines", ".machines [N]", "how many virtual machines", &Session::machines},
      {".sensor", ".sensor [LABEL...]",
       "tip, Abbe levers and uncertainty of standard tasks, for every stylus system or some", &Session::sensor},
      {".compare", ".compare A B", "the same for two, with their ratio", &Session::compare},
      {".load", ".load FILE", "begin with the program in a file", &Session::load_command},
      {".save", ".save [FILE]", "write the program to a file", &Session::save},
      {".quit", ".quit", "end the session", &Session::quit}};
  return table;
}

std::string Session::command(const std::string& line) {
  std::istringstream words(line);
  std::string word;
  words >> word;
  std::vector<std::string> operands;
  for (std::string operand; words >> operand;) operands.push_back(operand);
  try {
    const auto it =
        std::find_if(commands().begin(), commands().end(), [&](const Command& c) { return c.word == word; });
    if (it != commands().end()) return (this->*it->run)(operands);
    std::vector<std::string_view> known;
    for (const Command& c : commands()) known.push_back(c.word);
    const std::string near = nearest_word(word, known);
    throw UserError(diagnostic(Code::E0612, fmt::format("there is no command {}", word),
                               near.empty() ? ".help lists the commands" : fmt::format("did you mean {}?", near)));
  } catch (const UserError& error) {
    return rendered(error);
  }
}

std::string Session::help(const std::vector<std::string>&) {
  std::string out = "A line is a statement of DMIS, or one of these commands:\n";
  for (const Command& c : commands()) out += fmt::format("  {:<22}{}\n", c.form, c.help);
  return out +
      "Blocks (MEAS..ENDMES, IF..ENDIF, ...) are taken when they are complete. OUTPUT and EVAL "
      "show their results at once.\n";
}

std::string Session::list(const std::vector<std::string>&) {
  const SourceFile source("", text());
  std::string out;
  for (int line = 1; line < source.line_count(); ++line) out += fmt::format("{:>4}  {}\n", line, source.line(line));
  return out.empty() ? "nothing has been entered\n" : out;
}

std::string Session::run(const std::vector<std::string>&) {
  const CompiledProgram program = compiled(text());
  if (program.compilation.plan.characteristics.empty())
    return "nothing is evaluated yet: enter an OUTPUT or EVAL with a tolerance\n";
  return evaluate(program, 0);
}

std::string Session::undo(const std::vector<std::string>&) {
  if (!pending_.empty()) return drop();
  if (entries_.empty()) return "nothing has been entered\n";
  const std::string last = entries_.back();
  entries_.pop_back();
  return fmt::format("taken back: {}{}", last.substr(0, last.find('\n') + 1),
                     std::count(last.begin(), last.end(), '\n') > 1 ? "  ...\n" : "");
}

std::string Session::machine(const std::vector<std::string>& operands) {
  const CompiledProgram program = compiled(text());
  std::string out;
  if (!operands.empty()) {
    const auto before = std::exchange(settings_.machine, operands[0]);
    try {
      out = tried(program);
    } catch (const UserError& error) {
      settings_.machine = before;
      return rendered(error) + fmt::format("the machine is still {}\n", machine_name(program, before));
    }
  }
  const Machine now = read_machine(machine_name(program, settings_.machine));
  return out +
      fmt::format("machine {}: travel {:.0f} x {:.0f} x {:.0f} mm\n", now.name, now.axes[0].travel_mm,
                  now.axes[1].travel_mm, now.axes[2].travel_mm);
}

std::string Session::machines(const std::vector<std::string>& operands) {
  if (!operands.empty()) {
    const std::string& digits = operands[0];
    const bool whole = digits.size() < 8 && digits.find_first_not_of("0123456789") == std::string::npos;
    if (!whole || std::stoi(digits) < 2) missing(command_named(".machines"), "a whole number from 2 on");
    settings_.machines = std::stoi(digits);
  }
  return fmt::format("{} virtual machines\n", settings_.machines.value_or(kDefaultMachines));
}

std::vector<plan::SensorDef> Session::candidates(const std::vector<std::string>& labels) const {
  const CompiledProgram program = compiled(text());
  std::vector<plan::SensorDef> known;
  const auto add = [&](const plan::SensorDef& def) {
    std::erase_if(known, [&](const plan::SensorDef& k) { return upper(k.label) == upper(def.label); });
    known.push_back(def);
  };
  for (const auto& [name, sensor] : read_machine(machine_name(program, settings_.machine)).sensors) {
    plan::SensorDef def;
    def.label = name;
    def.from_machine_file = true;
    add(def);
  }
  for (const plan::SensorDef& def : program.compilation.plan.sensors) add(def);
  if (labels.empty()) return known;
  std::vector<plan::SensorDef> chosen;
  std::vector<std::string_view> names;
  for (const plan::SensorDef& def : known) names.push_back(def.label);
  for (const std::string& label : labels) {
    const auto it = std::find_if(known.begin(), known.end(), [&](const plan::SensorDef& def) {
      return upper(def.label) == upper(bare_label(label));
    });
    if (it == known.end())
      throw UserError(diagnostic(
          Code::E0614, fmt::format("there is no sensor '{}'", bare_label(label)),
          known.empty() ? "define one with S(name)=SNSDEF/..." : fmt::format("known: {}", fmt::join(names, ", "))));
    chosen.push_back(*it);
  }
  return chosen;
}

std::string Session::sensor(const std::vector<std::string>& operands) {
  const std::vector<plan::SensorDef> sensors = candidates(operands);
  if (sensors.empty()) return "no sensor is defined: enter S(name)=SNSDEF/..., or use a machine file with sensors\n";
  const CompiledProgram program = compiled(text());
  const Machine now = read_machine(machine_name(program, settings_.machine));
  return sensor_table(sensor_figures(sensors, now, program.source, settings_)) +
      fmt::format(
             "lengths of {:.0f} mm along X, Y, Z and a sphere of 30 mm with 25 points, in the "
             "middle of {};\n"
             "form: upper 95 % limit\n",
             standard_length_mm(now), now.name);
}

std::string Session::compare(const std::vector<std::string>& operands) {
  if (operands.size() != 2) missing(command_named(".compare"), "two sensors");
  const CompiledProgram program = compiled(text());
  const Machine now = read_machine(machine_name(program, settings_.machine));
  const auto figures = sensor_figures(candidates(operands), now, program.source, settings_);
  std::string out = sensor_table(figures);
  if (!figures[0].tasks || !figures[1].tasks) return out;
  const TaskUncertainties &a = *figures[0].tasks, &b = *figures[1].tasks;
  out += fmt::format("{:<70}", fmt::format("{} / {}", figures[1].label, figures[0].label));
  for (std::size_t k = 0; k < 3; ++k) out += ratio(b.length_mm[k], a.length_mm[k]);
  return out + ratio(b.size_mm, a.size_mm) + ratio(b.form_mm, a.form_mm) + "\n";
}

std::string Session::load(const std::string& path) {
  const SourceFile source = read_source(path);
  refuse_other_kind(source, FileKind::program);
  const std::string text = without_end(source);
  const std::string old_path = std::exchange(path_, path);
  const CompiledProgram program = compiled(text);
  std::string out;
  for (const Diagnostic& d : program.messages) out += render(d);
  bool usable = !program.has_errors;
  try {
    if (usable) out += tried(program);
  } catch (const UserError& error) {
    out += rendered(error);
    usable = false;
  }
  if (!usable) {
    path_ = old_path;
    return out + fmt::format("{} has errors and was not loaded\n", path);
  }
  const std::size_t count = program.compilation.plan.characteristics.size();
  entries_ = {text};
  pending_.clear();
  return out +
      fmt::format("{}: {} lines, {}{}\n", path, std::count(text.begin(), text.end(), '\n'),
                  counted(count, "characteristic"), count > 0 ? "; .run evaluates" : "");
}

std::string Session::load_command(const std::vector<std::string>& operands) {
  if (operands.empty()) missing(command_named(".load"), "a file");
  return load(operands[0]);
}

std::string Session::save(const std::vector<std::string>& operands) {
  const std::string path = operands.empty() ? path_ : operands[0];
  if (path.empty()) missing(command_named(".save"), "a file");
  Sink sink;
  lang::compile(SourceFile("session", text()), sink);
  const bool has_begin =
      std::none_of(sink.list().begin(), sink.list().end(), [](const Diagnostic& d) { return d.code == Code::W0226; });
  write_whole(path, (has_begin ? "" : "DMISMN/'session',5.2\n") + text() + "ENDFIL\n");
  path_ = path;
  std::string out = fmt::format("{} written\n", path);
  for (const Diagnostic& d : sink.list())
    if (d.code == Code::E0233) out += render(d);
  return out;
}

std::string Session::quit(const std::vector<std::string>&) {
  finished_ = true;
  return "";
}

}  // namespace abbe
