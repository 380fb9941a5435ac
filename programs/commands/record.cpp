// `abbe record`: what one virtual machine reports of a program, touch by touch, with any effects at work.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <compare>
#include <cstdint>
#include <limits>

#include "engine/base/files.hpp"
#include "engine/base/numbers.hpp"
#include "engine/effects/effect.hpp"
#include "engine/math/units.hpp"
#include "engine/report/dmis_result.hpp"
#include "engine/run/effect_set.hpp"
#include "engine/run/effect_settings.hpp"
#include "programs/commands/commands.hpp"
#include "programs/commands/usable_program.hpp"
#include "programs/terminal.hpp"

namespace abbe {

namespace {

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw UserError(diagnostic(
      Code::E0610, fmt::format("--with {}: {}", text, why),
      "write --with EFFECT or --with EFFECT:parameter=value,parameter=value; `abbe explain EFFECT` lists the parameters"));
}

/// "value" as a number, or as the word of a choice.
EffectSetting::Value parameter_value(const std::string& text) {
  EffectSetting::Value value;
  if (const std::optional<double> number = finite_number(text))
    value.value = *number;
  else
    value.word = text;
  return value;
}

/// EFFECT[:name=value,...]. An effect that is given without parameters acts with the typical size of its first
/// one: a size of zero would do nothing.
EffectSetting effect_setting(const std::string& text) {
  EffectSetting setting;
  setting.option = "--with " + text;
  const std::size_t colon = text.find(':');
  setting.name = text.substr(0, colon);
  if (colon == std::string::npos) {
    if (const Effect* effect = find_effect(setting.name); effect && !effect->parameters.empty())
      setting.parameters[std::string(effect->parameters[0].name)].value = effect->parameters[0].typical;
    return setting;
  }
  for (std::size_t begin = colon + 1; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string item = text.substr(begin, end - begin);
    const std::size_t equals = item.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == item.size())
      refuse(text, fmt::format("'{}' is not parameter=value", item));
    const bool first =
        setting.parameters.emplace(item.substr(0, equals), parameter_value(item.substr(equals + 1))).second;
    if (!first) refuse(text, fmt::format("'{}' is given twice", item.substr(0, equals)));
    begin = end + 1;
  }
  return setting;
}

/// Warns of effects that did nothing: an expansion at 20 degrees C, a head that does not turn.
void tell_idle(const std::vector<std::string>& with, const Machine& machine, const EffectActivities& activities) {
  const std::size_t own = machine.effects.size() - with.size();
  for (std::size_t k = 0; k < with.size(); ++k) {
    if (activities[own + k].moved) continue;
    const std::string& name = machine.effects[own + k].name;
    const EffectParameter* size = missing_size(machine.effects[own + k]);
    const bool drawn = !size && find_effect(name)->draws_per == DrawsPer::touch;
    print_messages({diagnostic(
        Code::W0615, fmt::format("--with {}: it {} no touch of this program", with[k], drawn ? "moved" : "moves"),
        size ? fmt::format("its {} is 0: give it a size, such as {}={:g}", size->name, size->name, size->typical)
            : drawn
            ? fmt::format("it is drawn for each touch, and none came that shows: another --seed, or a larger size; see "
                          "`abbe explain {}`",
                          name)
            : fmt::format(
                  "`abbe explain {}` says on what it depends; temperatures and loads come from a workpiece file",
                  name))});
  }
}

/// The effects of the machine file, and those of the command line with their parameters.
std::string describe(const Machine& machine, const std::vector<std::string>& with) {
  std::vector<std::string> all;
  for (const EffectSetting& own : machine.effects) all.push_back(own.name + " (machine file)");
  all.insert(all.end(), with.begin(), with.end());
  return all.empty() ? "none" : fmt::format("{}", fmt::join(all, " "));
}

/// A step to which a machine rounds what it reads (noise.resolution).
struct Rounding {
  double step_mm;
  std::size_t effect;  ///< its place in the machine's list
  auto operator<=>(const Rounding&) const = default;
};

/// The roundings of the machine, the finest first. There they are set to zero: an error that is added to a touch makes no
/// multiples, and who looks at the digits would not know it.
std::vector<Rounding> take_roundings(Machine& machine) {
  const EffectSet refuses_what_cannot_be(machine.effects, EffectUse::left_in, machine.name);
  std::vector<Rounding> out;
  for (std::size_t k = 0; k < machine.effects.size(); ++k) {
    if (machine.effects[k].name != "noise.resolution") continue;
    EffectSetting::Value& step_um = machine.effects[k].parameters["resolution_um"];
    if (step_um.value > 0) out.push_back({step_um.value * kUm, k});
    step_um = {};
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// What the software of a machine makes of these touches, which carry all errors.
std::vector<OutputRecord> outputs_of(const Recording& recording, const plan::Plan& plan, const Machine& machine,
                                     const VirtualMachines& one, RunOptions run, const SourceFile& source) {
  run.recorded = &recording;
  run.workpiece = nullptr;
  run.contributors = Contributors::none();
  return record_plan(plan, machine, one, run, source).outputs;
}

/// Every run indexes the head anew, and as often as the runs before it: its visits count on from theirs.
void count_visits_on(Recording& recording, int runs_before) {
  std::int64_t of_a_run = 0;
  for (const RecordingRow& row : recording.rows) of_a_run = std::max<std::int64_t>(of_a_run, row.visit.value_or(0));
  for (RecordingRow& row : recording.rows)
    if (row.visit)
      row.visit = static_cast<int>(
          std::min<std::int64_t>(*row.visit + runs_before * of_a_run, std::numeric_limits<int>::max()));
}

}  // namespace

int record_command(const RecordOptions& options) {
  const CompiledProgram program = usable_program(options.program, options.answers);
  print_messages(program.messages);
  const lang::Directives& asked = program.compilation.directives;
  StudySettings settings;
  settings.machine = options.machine;
  settings.workpiece = options.workpiece;
  const StudyInputs inputs = read_inputs(program, settings);
  refuse_overwriting(inputs.files, files_given({options.output, options.dmo}));
  const std::optional<Workpiece>& workpiece = inputs.workpiece;
  Machine machine = inputs.machine;
  for (const std::string& with : options.with) machine.effects.push_back(effect_setting(with));

  RunOptions run;
  run.workpiece = workpiece ? &*workpiece : nullptr;
  run.seed = options.seed.value_or(asked.seed.value_or(1));
  run.repeat = options.run - 1;
  run.setup = options.setup;
  const plan::Plan& plan = program.compilation.plan;
  print_messages(machine_warnings(machine));
  const Placement placement = placement_of(program, machine);
  run.placement_mm = placement.shift_mm;
  if (placement.message) print_messages({*placement.message});
  const std::vector<Rounding> roundings = take_roundings(machine);
  const VirtualMachines one = screened_machines(machine, run.seed, 1, 1);
  MachineRecord record = record_plan(plan, machine, one, run, program.source);
  print_messages(record.warnings);
  count_visits_on(record.recording, run.repeat);
  for (const Rounding& rounding : roundings) {
    round_readings(record.recording, rounding.step_mm);
    record.activities[rounding.effect].moved = true;
  }
  auto& metadata = record.recording.metadata;
  const std::pair<std::string, std::string> origin[] = {{"machine", inputs.machine_name},
                                                        {"program", program.source.name()},
                                                        {"seed", std::to_string(run.seed)},
                                                        {"effects", describe(inputs.machine, options.with)},
                                                        {"made_by", "abbe " ABBE_VERSION}};
  metadata.insert(metadata.begin(), std::begin(origin), std::end(origin));
  if (workpiece) metadata.emplace_back("workpiece", workpiece->name);
  std::vector<OutputFile> files;
  files.push_back({options.output, to_csv(record.recording)});
  if (options.dmo) {
    if (!roundings.empty()) record.outputs = outputs_of(record.recording, plan, machine, one, run, program.source);
    files.push_back({*options.dmo, dmis_result(plan, record.outputs)});
  }
  write_together(files);
  tell_idle(options.with, machine, record.activities);
  return kDone;
}

}  // namespace abbe
