// abbe check PROGRAM.dmi...: every message about the programs, and on request their plans. Nothing
// is run.
#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "engine/base/diagnostic.hpp"
#include "lang/compile.hpp"
#include "programs/commands/commands.hpp"
#include "programs/terminal.hpp"

namespace abbe {
namespace {

struct Checked {
  std::vector<Diagnostic> messages;  ///< by place
  plan::Plan plan;
};

Checked check(const std::string& path, const std::map<std::string, std::string>& answers) {
  Sink sink;
  lang::Compilation compilation = lang::compile(read_text(path, sink), sink, {answers});
  return {sink.sorted(), std::move(compilation.plan)};
}

std::string_view severity_name(Severity severity) {
  return severity == Severity::error ? "error" : severity == Severity::warning ? "warning" : "note";
}

nlohmann::ordered_json to_json(const Diagnostic& d) {
  return {{"code", info(d.code).name},
          {"severity", severity_name(d.severity())},
          {"file", d.file},
          {"line", d.place.line},
          {"column", d.place.column},
          {"message", d.message},
          {"help", d.help}};
}

/// Names and labels keep the bytes of the file, which need not be UTF-8; JSON must be.
std::string indented(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

int check_command(const CheckOptions& options) {
  const bool as_json = options.format == "json";
  nlohmann::ordered_json messages = nlohmann::ordered_json::array(),
                         plans = nlohmann::ordered_json::object();
  std::size_t errors = 0, warnings = 0;
  for (const std::string& program : options.programs) {
    const Checked checked = check(program, options.answers);
    for (const Diagnostic& d : checked.messages) {
      errors += d.severity() == Severity::error ? 1 : 0;
      warnings += d.severity() == Severity::warning ? 1 : 0;
      if (as_json)
        messages.push_back(to_json(d));
      else
        fmt::print(stderr, "{}", render(d));
    }
    if (!options.plan) continue;
    if (as_json)
      plans[program] = plan::to_text(checked.plan);
    else
      fmt::print("{}", plan::to_text(checked.plan));
  }
  if (as_json) {
    nlohmann::ordered_json out = {{"schema", "abbe.check/1"}, {"messages", messages}};
    if (options.plan) out["plans"] = plans;
    fmt::print("{}\n", indented(out));
  } else {
    fmt::print("{}, {} in {}\n", counted(errors, "error"), counted(warnings, "warning"),
               counted(options.programs.size(), "program"));
  }
  return errors > 0 ? kNo : kDone;
}

}  // namespace abbe
