// `abbe machine list | show M | screen M | init NAME`.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/base/files.hpp"
#include "engine/machine/shipped.hpp"
#include "engine/run/effect_set.hpp"
#include "programs/commands/commands.hpp"
#include "programs/commands/machine_report.hpp"
#include "programs/terminal.hpp"
#include "programs/thread_count.hpp"

namespace abbe {

namespace {

int list(const MachineOptions& options) {
  std::string text;
  nlohmann::ordered_json machines = nlohmann::ordered_json::array();
  for (const std::string& name : shipped_machines()) {
    const Machine m = read_machine(name);
    const Specification& spec = m.specification;
    text += fmt::format("{:<20} {:g} x {:g} x {:g} mm, MPE {} ({})\n", name, m.axes[0].travel_mm, m.axes[1].travel_mm,
                        m.axes[2].travel_mm, length_mpe_text(spec.mpe), spec.standard);
    machines.push_back({{"name", name},
                        {"travel_mm", {m.axes[0].travel_mm, m.axes[1].travel_mm, m.axes[2].travel_mm}},
                        {"mpe", length_mpe_json(spec.mpe)},
                        {"standard", spec.standard}});
  }
  print_result(options.format == "json"
                   ? nlohmann::ordered_json{{"schema", "abbe.machine_list/1"}, {"machines", machines}}.dump(2) + "\n"
                   : text);
  return kDone;
}

/// A machine whose effects exist and can be as they are described: what runs ask of it.
Machine usable_machine(const std::string& name) {
  Machine machine = read_machine(name);
  const EffectSet checked(machine.effects, EffectUse::left_in, machine.name);
  return machine;
}

int show(const MachineOptions& options) {
  MachineReport report;
  report.machine = usable_machine(options.machine);
  report.seed = options.seed;
  report.drawn = screened_machines(report.machine, options.seed, 1, thread_count(options.threads));
  report.lines = test_lines(report.machine);
  report.tested = virtual_acceptance_test(report.machine, report.drawn.geometry[0]);
  report.messages = machine_warnings(report.machine);
  if (options.format != "json") print_messages(report.messages);
  print_result(options.format == "json" ? machine_report_json(report) : machine_report_text(report));
  return kDone;
}

LineReport line_report(const TestLine& line, std::size_t number, const std::vector<TestResult>& results) {
  LineReport out{line, 0, 0, 0};
  std::vector<double> worst;
  for (const TestResult& result : results) {
    double share = 0;
    for (int m = 0; m < kLengthsPerLine; ++m)
      share = std::max(share, std::abs(result.error_mm[number][m]) / line.mpe_mm[m]);
    worst.push_back(share);
  }
  std::sort(worst.begin(), worst.end());
  out.median = worst[worst.size() / 2];
  out.p95 = worst[worst.size() * 95 / 100];
  out.largest = worst.back();
  return out;
}

int screen(const MachineOptions& options) {
  if (options.machines < 1)
    throw UserError(diagnostic(Code::E0603, fmt::format("--machines is {}, but must be at least 1", options.machines)));
  ScreeningReport report;
  report.machine = usable_machine(options.machine);
  report.seed = options.seed;
  ProgressLine progress;
  progress.show("screening virtual machines");
  const VirtualMachines machines =
      screened_machines(report.machine, options.seed, options.machines, thread_count(options.threads));
  report.counts = machines.counts;
  std::vector<TestResult> results;
  for (const GeometryCoefficients& one : machines.geometry)
    results.push_back(virtual_acceptance_test(report.machine, one));
  const auto lines = test_lines(report.machine);
  for (std::size_t k = 0; k < lines.size(); ++k) report.lines.push_back(line_report(lines[k], k, results));
  report.probe = probe_checks(report.machine, options.seed);
  progress.show("looking for a factor on e_max");
  report.suggested =
      suggest_e_max_factor(report.machine, options.seed, kSuggestionCandidates, thread_count(options.threads));
  report.messages = machine_warnings(report.machine);
  if (const auto warning =
          screening_warning(report.machine, report.counts, options.seed, thread_count(options.threads)))
    report.messages.push_back(*warning);
  for (Diagnostic& warning : probe_warnings(report.machine, report.probe))
    report.messages.push_back(std::move(warning));
  if (options.format != "json") print_messages(report.messages);
  print_result(options.format == "json" ? screening_json(report) : screening_text(report));
  return kDone;
}

/// A complete machine file: that of the paper, under another name.
std::string machine_template(const std::string& name) {
  constexpr std::string_view kPaper = "coord3-mc16";
  const auto files = shipped_machine_files();
  const auto paper = std::find_if(files.begin(), files.end(), [&](const ShippedFile& f) { return f.name == kPaper; });
  std::string text(paper->text);
  const std::string own_name = fmt::format("\"name\": \"{}\"", kPaper);
  return text.replace(text.find(own_name), own_name.size(), fmt::format("\"name\": \"{}\"", name));
}

/// Prints the file, or writes it when the name is that of a file: "init mine.json".
int init(const MachineOptions& options) {
  constexpr std::string_view kEnding = ".json";
  const bool to_file = options.machine.ends_with(kEnding);
  const std::string name = to_file ? std::filesystem::path(options.machine).stem().string() : options.machine;
  const auto plain = [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '_' || c == '.'; };
  if (name.empty() || !std::all_of(name.begin(), name.end(), plain))
    throw UserError(diagnostic(Code::E0603, fmt::format("'{}' cannot be the name of a machine", name),
                               "use letters, digits, '-', '_' and '.'; with .json at the end the file is written"));
  if (to_file && is_there(options.machine))
    throw UserError(diagnostic(Code::E0602, fmt::format("'{}' exists already and was left as it is", options.machine),
                               "choose another name, or delete the file first"));
  const std::string text = machine_template(name);
  if (!to_file) {
    print_result(text);
    return kDone;
  }
  write_whole(options.machine, text);
  print_hint(fmt::format("wrote {}: adapt it to your machine, then look at it with `abbe machine show {}`\n",
                         options.machine, options.machine));
  return kDone;
}

}  // namespace

int machine_command(const MachineOptions& options) {
  if (options.action == "list") return list(options);
  if (options.action == "show") return show(options);
  if (options.action == "screen") return screen(options);
  return init(options);
}

}  // namespace abbe
