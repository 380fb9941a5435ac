// `abbe diagnose`: do recordings agree with the machine, and if not, what was left out?
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "engine/base/files.hpp"
#include "engine/report/diagnosis/diagnosis_report.hpp"
#include "engine/run/recorded_part.hpp"
#include "engine/run/recorded_sensor.hpp"
#include "engine/run/recorded_touch.hpp"
#include "programs/commands/recorded_values.hpp"
#include "programs/commands/usable_program.hpp"
#include "programs/recorded_points.hpp"
#include "programs/terminal.hpp"
#include "programs/thread_count.hpp"

namespace abbe {

namespace {

/// First and last time of a recording, if any.
std::optional<std::pair<double, double>> time_span(const Recording& r) {
  std::optional<std::pair<double, double>> span;
  for (const RecordingRow& row : r.rows) {
    if (!row.time_s) continue;
    if (!span) span = {*row.time_s, *row.time_s};
    span = {std::min(span->first, *row.time_s), std::max(span->second, *row.time_s)};
  }
  return span;
}

/// A machine takes one recording at a time: where two overlap, the clock was set anew between them, and the
/// next one counts as measured later.
void continue_clock(const Recording& before, Recording& next, const std::string& file) {
  constexpr double kPause_s = 60;
  const auto past = time_span(before), own = time_span(next);
  if (!past || !own || own->first > past->second || own->second < past->first) return;
  const double later_s = past->second + kPause_s - own->first;
  for (RecordingRow& row : next.rows)
    if (row.time_s) *row.time_s += later_s;
  print_messages(
      {diagnostic(Code::N0708,
                  fmt::format("{}: its times overlap those of the recording ahead of it; they count as {:.0f} s later",
                              file, later_s),
                  "if it was measured at another time, write its true times into time_s")});
}

/// Whoever forgets to number the repeats has the same run in every file. The same touch with another value is
/// a further run, else the machine would seem to have changed in the middle of one.
void continue_runs(const Recording& before, Recording& next, const std::string& file) {
  const auto named = [](const RecordingRow& row) { return std::tie(row.feature, row.touch, row.setup, row.run); };
  std::map<std::tuple<std::string, int, int, int>, Vec3> touched;
  for (const RecordingRow& row : before.rows) touched.emplace(named(row), row.position_mm);
  const bool again = std::any_of(next.rows.begin(), next.rows.end(), [&](const RecordingRow& row) {
    const auto found = touched.find(named(row));
    return found != touched.end() && !(found->second == row.position_mm);
  });
  if (!again) return;
  const auto in_run_order = [](const RecordingRow& a, const RecordingRow& b) { return a.run < b.run; };
  const int last = std::max_element(before.rows.begin(), before.rows.end(), in_run_order)->run;
  const int first = std::min_element(next.rows.begin(), next.rows.end(), in_run_order)->run;
  for (RecordingRow& row : next.rows) row.run += last + 1 - first;
  print_messages({diagnostic(
      Code::N0708,
      fmt::format("{}: it repeats touches of the recording ahead of it under the same run; its runs are counted on: "
                  "run {} counts as {}",
                  file, first, last + 1),
      "give every repeat its own number in the column 'run'")});
}

/// Between two files the styli may have been qualified anew, unless all say by the column `qualification` that they were
/// not.
void doubt_qualifications(std::vector<Recording>& files) {
  const auto unsaid = [](const RecordingRow& row) { return !row.qualification; };
  const auto says = [&](const Recording& r) { return std::none_of(r.rows.begin(), r.rows.end(), unsaid); };
  if (files.size() < 2 || std::all_of(files.begin(), files.end(), says)) return;
  int before = 0;
  for (Recording& r : files) {
    int last = before;
    for (RecordingRow& row : r.rows) {
      row.qualification = before + row.qualification.value_or(1);
      last = std::max(last, *row.qualification);
    }
    before = last;
  }
}

/// A file given twice is no repeat: nothing was measured again.
void refuse_copy(const Recording& before, const std::string& name, const Recording& next, const std::string& copy) {
  const auto same = [](const RecordingRow& a, const RecordingRow& b) {
    return a.feature == b.feature && a.touch == b.touch && a.setup == b.setup && a.run == b.run &&
        a.position_mm == b.position_mm && a.time_s == b.time_s;
  };
  if (std::search(before.rows.begin(), before.rows.end(), next.rows.begin(), next.rows.end(), same) ==
      before.rows.end())
    return;
  throw UserError(diagnostic(Code::E0713, fmt::format("'{}' holds the same touches as '{}'", copy, name),
                             "give each recording once; a repeat has other values, and another 'run'"));
}

/// Recordings of one machine belong together.
void doubt_machine(const Recording& first, const std::string& name, const Recording& next, const std::string& file) {
  const auto one = said(first.metadata, "machine"), other = said(next.metadata, "machine");
  if (one && other && *one != *other)
    print_messages({diagnostic(
        Code::W0714,
        fmt::format("'{}' is of machine '{}', '{}' of '{}'; they are judged as one machine", name, *one, file, *other),
        "judge each machine by its own recordings")});
}

/// Files that are one recording have positions of one kind.
void refuse_unlike(const Recording& first, const std::string& name, const Recording& next, const std::string& file) {
  if (next.in_part_frame != first.in_part_frame || next.point != first.point)
    throw UserError(diagnostic(Code::E0707, fmt::format("'{}' and '{}' have different frames or points", name, file),
                               "the lines '# frame:' and '# point:' must say the same in all files"));
  const auto surfaces = said(first.metadata, "surfaces"), others = said(next.metadata, "surfaces");
  if (surfaces && others && *surfaces != *others)
    throw UserError(diagnostic(
        Code::E0707, fmt::format("'# surfaces:' says {} in '{}' and {} in '{}'", *surfaces, name, *others, file),
        "judge them one by one, or say of both what holds for both"));
}

/// Several files are one recording.
Recording joined(const std::vector<SourceFile>& files, Positions positions) {
  std::vector<Recording> read;
  for (const SourceFile& file : files) {
    read.push_back(read_recording(file, positions));
    refuse_unlike(read.front(), files.front().name(), read.back(), file.name());
    for (std::size_t k = 0; k + 1 < read.size(); ++k) refuse_copy(read[k], files[k].name(), read.back(), file.name());
  }
  doubt_qualifications(read);
  Recording all = std::move(read.front());
  for (std::size_t k = 1; k < files.size(); ++k) {
    const std::string& name = files[k].name();
    Recording& one = read[k];
    doubt_machine(all, files[0].name(), one, name);
    continue_clock(all, one, name);
    continue_runs(all, one, name);
    all.rows.insert(all.rows.end(), one.rows.begin(), one.rows.end());
    // new styli; of what is said twice the first counts
    all.metadata.insert(all.metadata.end(), one.metadata.begin(), one.metadata.end());
  }
  return all;
}

/// The machine to compare with: what the command line names, else what the recording names, else the default.
template <class Recorded>
std::string machine_of(const DiagnoseCommandOptions& options, Recorded recorded_machine) {
  if (options.known) return *options.known;
  if (options.machine) return *options.machine;
  const std::string recorded = recorded_machine();
  return recorded.empty() ? kDefaultMachine : recorded;
}

/// Every file was read once: a recording may come through a pipe.
struct Files {
  std::vector<SourceFile> recordings;
  std::optional<Workpiece> workpiece;
};

/// Before the work: a diagnosis takes minutes. `programs`: those that were compiled, with their modules.
void protect_files(const DiagnoseCommandOptions& options, const Files& read, const std::vector<std::string>& programs,
                   const std::string& machine) {
  std::vector<std::string> inputs = programs;
  inputs.push_back(machine);
  for (const std::string& file : files_of(read.workpiece)) inputs.push_back(file);
  inputs.insert(inputs.end(), options.recordings.begin(), options.recordings.end());
  refuse_overwriting(inputs, files_given({options.report, options.model_out}));
}

struct Answer {
  Diagnosis diagnosis;
  std::string machine;  ///< that it was compared with
};

Answer of_values(const DiagnoseCommandOptions& options, const Files& read, const DiagnoseOptions& how) {
  const RecordedValues values(read.recordings.front(), options.program);
  const std::string name = machine_of(options, [&] { return values.machine(); });
  protect_files(options, read, values.files(), name);
  return {values.diagnosis(read_machine(name), how), name};
}

Answer of_touches(const DiagnoseCommandOptions& options, const Files& read, const DiagnoseOptions& how) {
  Recording recording = joined(read.recordings, options.design_only ? Positions::or_targets : Positions::recorded);
  const std::string file = fmt::format("{}", fmt::join(options.recordings, ", "));
  const std::string name = machine_of(
      options, [&] { return recorded_machine(said(recording.metadata, "machine").value_or(""), options.recordings); });
  const std::optional<CompiledProgram> program =
      options.program ? std::optional(usable_program(*options.program)) : std::nullopt;
  protect_files(options, read, program ? files_compiled(*program) : std::vector<std::string>{}, name);
  Machine machine = read_machine(name);
  if (options.known && !machine.known_state)
    print_messages({diagnostic(Code::W0715, fmt::format("'{}' has no known_state: the machine counts as new", name),
                               "`abbe diagnose --model-out` writes one; --machine takes a file without")});
  if (program) complete_from_program(recording, nominal_record(*program, machine), file);
  if (how.workpiece) fill_from_workpiece(recording, *how.workpiece);
  std::vector<Diagnostic> messages;
  add_recorded_sensors(recording, machine, file, messages);
  Diagnosis answer = diagnose_recording(recording, machine, how, file);
  answer.messages.insert(answer.messages.begin(), messages.begin(), messages.end());
  return {std::move(answer), name};
}

}  // namespace

int diagnose_command(const DiagnoseCommandOptions& options) {
  Files read;
  for (const std::string& file : options.recordings) read.recordings.push_back(read_text_aloud(file));
  if (options.workpiece) read.workpiece = read_workpiece(*options.workpiece);
  DiagnoseOptions how;
  how.workpiece = read.workpiece ? &*read.workpiece : nullptr;
  how.seed = options.seed.value_or(1);
  how.threads = thread_count(options.threads);
  how.design_only = options.design_only;
  how.keep_state = options.model_out.has_value();
  const auto [d, machine] = [&] {
    ProgressLine line;
    how.progress = [&](std::string_view step) { line.show(step); };
    return are_values(read.recordings) ? of_values(options, read, how) : of_touches(options, read, how);
  }();
  print_messages(d.messages);
  std::vector<OutputFile> files;
  if (options.model_out) files.push_back({*options.model_out, improved_machine(machine_text(machine), d)});
  if (options.report)
    files.push_back(
        {*options.report, diagnosis_html(d, fmt::format("{}", fmt::join(options.recordings, ", ")), machine)});
  write_together(files);
  print_result(options.format == "json" ? diagnosis_json(d) : diagnosis_text(d));
  return options.fail_on_mismatch && is_mismatch(d) ? kNo : kDone;
}

}  // namespace abbe
