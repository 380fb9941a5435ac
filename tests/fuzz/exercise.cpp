#include "tests/fuzz/exercise.hpp"

#include <cstdio>
#include <cstdlib>

#include "engine/run/run.hpp"
#include "lang/compile.hpp"
#include "lang/format.hpp"
#include "lang/labels.hpp"

namespace abbe::fuzz {

namespace {

void require(bool holds, const char* what, const std::string& text) {
  if (holds) return;
  std::fprintf(stderr, "fuzz: %s\n%s\n", what, text.c_str());
  std::abort();
}

/// Machines are drawn once: a program is what is under test.
struct World {
  Machine machine = read_machine("coord3-mc16");
  VirtualMachines machines = screened_machines(machine, 1, 2, 1);
};

bool runs(const plan::Plan& plan, const SourceFile& source) {
  static const World world;
  try {
    run_plan(plan, world.machine, world.machines, RunOptions{}, source);
    return true;
  } catch (const UserError&) {
    return false;
  }
}

}  // namespace

Outcome exercise(const std::string& text) {
  const SourceFile source("fuzz.dmi", text);
  Sink sink;
  const lang::Compilation compilation = lang::compile(source, sink);
  for (const Diagnostic& d : sink.list()) {
    require(d.span && d.span->begin <= d.span->end && d.span->end <= text.size(), "a message without a place", text);
    require(!d.message.empty() && !render(d).empty(), "a message without words", text);
  }
  for (const lang::LabelUse& use : lang::label_uses(source))
    require(use.span.begin <= use.name_span.begin && use.name_span.begin <= use.name_span.end &&
                use.name_span.end <= use.span.end && use.span.end <= text.size(),
            "a label outside the text", text);

  const std::string formatted = lang::format(source);
  const SourceFile again("fuzz.dmi", formatted);
  require(lang::format(again) == formatted, "formatting twice differs", text);
  Sink formatted_sink;
  require(to_text(lang::compile(again, formatted_sink).plan) == to_text(compilation.plan),
          "formatting changes the plan", text);
  require(sink.list().size() == formatted_sink.list().size(), "formatting changes the messages", text);
  return {!sink.has_errors(), runs(compilation.plan, source)};
}

}  // namespace abbe::fuzz
