#include "programs/recorded_points.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "engine/base/letter_case.hpp"
#include "engine/diagnose/diagnosis.hpp"
#include "engine/run/recorded/from_program.hpp"
#include "engine/run/recorded/sensor_lines.hpp"
#include "engine/run/recorded/touch.hpp"

namespace abbe {

namespace {

/// A virtual machine measures the part once.
void check_one_run(const Recording& r, const std::string& file) {
  const RecordingRow& first = r.rows.front();
  for (const RecordingRow& row : r.rows)
    if (row.run != first.run || row.setup != first.setup)
      throw UserError(diagnostic(Code::E0559,
                                 fmt::format("{}: line {} is of run {} and setup {}, line {} of run {} and setup {}",
                                             file, first.line, first.run, first.setup, row.line, row.run, row.setup),
                                 "errors are added to the points of one run in one placement: keep the rows of one"));
}

void check_complete(const Recording& r, const Recording& nominal, const std::string& file) {
  constexpr std::size_t kTold = 3;
  std::set<std::pair<std::string, int>> recorded;
  for (const RecordingRow& row : r.rows) recorded.emplace(upper(row.feature), row.touch);
  std::vector<std::string> missing;
  for (const RecordingRow& row : nominal.rows)
    if (!recorded.contains({upper(row.feature), row.touch}))
      missing.push_back(fmt::format("touch {} of '{}'", row.touch, row.feature));
  if (missing.empty()) return;
  const std::size_t all = missing.size();
  missing.resize(std::min(all, kTold));
  throw UserError(
      diagnostic(Code::E0560,
                 fmt::format("{}: the program makes {}{}, and the recording has no such row", file,
                             fmt::join(missing, ", "), all > kTold ? fmt::format(", and {} more", all - kTold) : ""),
                 "give the recording of a whole run of this program, or without --recording take its nominal points"));
}

/// The program's machine takes off the radius of its own tip.
void check_tips_of_program(const Recording& r, const MachineRecord& nominal, const Machine& machine,
                           const std::string& file) {
  constexpr double kAlike_mm = 1e-3;
  std::map<std::pair<std::string, int>, double> radius_mm;
  for (std::size_t k = 0; k < nominal.aims.size(); ++k) {
    const RecordingRow& row = nominal.recording.rows[k];
    radius_mm[{upper(row.feature), row.touch}] = nominal.aims[k].radius_mm;
  }
  for (const RecordingRow& row : r.rows) {
    const auto sensor = machine.sensors.find(row.sensor.value_or(""));
    if (sensor == machine.sensors.end()) continue;
    const double recorded = sensor->second.radius_mm, own = radius_mm.at({upper(row.feature), row.touch});
    if (std::abs(recorded - own) < kAlike_mm) continue;
    throw UserError(diagnostic(
        Code::E0545,
        fmt::format("{}: line {}: '{}' touch {} was made with a ball of {:g} mm ('{}'), and the program makes it with "
                    "one of {:g} mm",
                    file, row.line, row.feature, row.touch, 2 * recorded, *row.sensor, 2 * own),
        "give the recording of this program, or correct its line '# sensor' or the program's SNSDEF"));
  }
}

}  // namespace

MachineRecord nominal_record(const CompiledProgram& program, const Machine& machine) {
  RunOptions run;
  run.contributors = Contributors::none();
  const plan::Plan& plan = program.compilation.plan;
  run.placement_mm = placement_of(program, machine).shift_mm;
  return record_plan(plan, machine, screened_machines(machine, 1, 1, 1), run, program.source);
}

std::vector<Diagnostic> check_recorded_points(const Recording& recorded, const CompiledProgram& program,
                                              const Machine& machine, const std::string& file) {
  check_one_run(recorded, file);
  const MachineRecord nominal = nominal_record(program, machine);
  Recording r = recorded;
  for (RecordingRow& row : r.rows) row.target_mm.reset(), row.normal.reset();  // the program's count
  complete_from_program(r, nominal, file);
  check_complete(r, nominal.recording, file);
  std::vector<Diagnostic> of_names;  // that the program's styli are not those of the machine file: its own count
  Machine mounted = machine;
  add_recorded_sensors(nominal.recording, mounted, file, of_names);
  add_recorded_sensors(recorded, mounted, file, of_names);
  check_tips_of_program(r, nominal, mounted, file);
  return recording_problems(r, mounted, file);
}

}  // namespace abbe
