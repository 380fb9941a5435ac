#include "programs/commands/recorded_values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "engine/base/file_kind.hpp"
#include "engine/base/files.hpp"
#include "engine/base/letter_case.hpp"
#include "engine/math/units.hpp"
#include "engine/recording/recording.hpp"
#include "lang/lines.hpp"
#include "lang/result_reader.hpp"
#include "programs/commands/usable_program.hpp"

namespace abbe {

namespace {

bool is_angle(const lang::ResultValue& v) {
  Arguments axis;
  if (!v.qualifier.empty()) axis.add_text("axis", v.qualifier);
  return unit_of(*v.kind, axis) == Unit::rad;
}

/// What is to be said of a result file. Of its features and coordinate systems, which no diagnosis of values looks at, only
/// where it has no end: a statement that cannot be read may be the last, and others missing. Throws UserError where something
/// is wrong with it.
std::vector<Diagnostic> said_of_result(const SourceFile& file, const std::vector<Diagnostic>& messages) {
  Sink told;
  const std::vector<lang::LogicalLine> lines = lang::logical_lines(file);
  const auto statement_of = [&](const Diagnostic& d) {
    const auto after = std::find_if(lines.begin(), lines.end(),
                                    [&](const lang::LogicalLine& line) { return line.line > d.place.line; });
    return after == lines.begin() ? std::string() : upper(std::prev(after)->code.text());
  };
  const bool whole = std::any_of(lines.begin(), lines.end(), [](const lang::LogicalLine& line) {
    return upper(line.code.text()).starts_with("ENDFIL");
  });
  for (const Diagnostic& d : messages)
    if (const std::string text = statement_of(d); !whole || (!text.starts_with("FA(") && !text.starts_with("DA(")))
      told.add(d);
  if (!whole)
    told.add(diagnostic(Code::W0561,
                        fmt::format("{}: the result file has no ENDFIL: values may be missing", file.name()),
                        "if it was cut off, copy it anew; if it is whole, write ENDFIL as its last line"));
  if (told.has_errors()) throw UserError(told.list());
  return told.list();
}

/// The evaluated tolerances of a result file as rows; their features and coordinate systems are passed over.
ValueRecording from_result(const SourceFile& file, std::vector<Diagnostic>& messages) {
  Sink sink;
  const lang::DmisResult result = lang::read_dmis_result(file, sink);
  for (Diagnostic& d : said_of_result(file, sink.sorted())) messages.push_back(std::move(d));
  ValueRecording out{file, {}, {}, {}};
  std::map<std::string, int> met;
  for (const lang::ResultValue& v : result.values) {
    ValueRow row;
    row.characteristic = v.label;
    row.value = is_angle(v) ? in_degrees(v.value) : v.value;
    row.last_digit = is_angle(v) ? in_degrees(v.last_digit) : v.last_digit;
    row.ordinal = ++met[v.label];
    row.span = {file.line_begin(v.line), file.line_begin(v.line) + 1};
    out.rows.push_back(std::move(row));
  }
  if (out.rows.empty())
    throw UserError(diagnostic(Code::E0557,
                               fmt::format("{}: no evaluated tolerance (TA) stands in this result file", file.name()),
                               "let the program put them out: OUTPUT/FA(...),TA(...)"));
  return out;
}

bool is_result(const std::string& file) { return file.ends_with(".dmo") || file.ends_with(".DMO"); }

}  // namespace

bool are_values(const std::vector<SourceFile>& files) {
  for (const SourceFile& file : files)
    if (!is_result(file.name())) refuse_other_kind(file, FileKind::table);
  const auto values = std::find_if(files.begin(), files.end(),
                                   [](const SourceFile& f) { return is_result(f.name()) || is_value_recording(f); });
  if (values != files.end() && files.size() > 1)
    throw UserError(
        diagnostic(Code::E0554, fmt::format("{} files were given and '{}' holds values", files.size(), values->name()),
                   "put the values of one machine into one file; the columns 'program' and 'run' keep them apart"));
  return values != files.end();
}

std::string recorded_machine(const std::string& named, const std::vector<std::string>& recordings) {
  if (named.empty()) return named;
  for (const std::string& recording : recordings)
    if (const std::string file = beside(recording, named); is_file(file)) return file;
  const std::vector<std::string> shipped = shipped_machines();
  if (std::find(shipped.begin(), shipped.end(), named) != shipped.end() || is_there(named)) return named;
  throw UserError(diagnostic(
      Code::E0411,
      fmt::format(
          "{}: '# machine: {}' names neither a file, beside the recording or in this folder, nor a shipped machine",
          fmt::join(recordings, ", "), named),
      "give --machine, put the machine file beside the recording, or correct the line"));
}

std::optional<std::string> name_of_recorded_machine(const std::string& named,
                                                    const std::vector<std::string>& recordings) {
  try {
    const std::string file = recorded_machine(named, recordings);
    return file.empty() ? std::nullopt : std::optional(read_machine(file).name);
  } catch (const UserError&) {
    return std::nullopt;
  }
}

RecordedValues::RecordedValues(const SourceFile& file, const std::optional<std::string>& program,
                               std::vector<Diagnostic>& messages)
    : recording_(is_result(file.name()) ? from_result(file, messages) : read_value_recording(file)) {
  messages.insert(messages.end(), recording_.messages.begin(), recording_.messages.end());
  const std::filesystem::path folder = std::filesystem::path(file.name()).parent_path();
  for (const ValueRow& row : recording_.rows) {
    if (std::find(names_.begin(), names_.end(), row.program) != names_.end()) continue;
    if (row.program.empty() && !program)
      throw UserError(
          diagnostic_at(recording_.source, row.span, Code::E0555, "which program evaluated this value is not said",
                        "give --program P.dmi, or a column 'program' with its path as seen from this file"));
    if (const std::string path = (folder / row.program).string(); !row.program.empty() && !is_file(path))
      throw UserError(diagnostic_at(recording_.source, row.span, Code::E0601, fmt::format("cannot read '{}'", path),
                                    "the column 'program' names the measurement program as seen from this file"));
    names_.push_back(row.program);
    programs_.push_back(usable_program(row.program.empty() ? *program : (folder / row.program).string()));
    const std::vector<Diagnostic>& told = programs_.back().messages;
    messages.insert(messages.end(), told.begin(), told.end());
  }
}

std::vector<std::string> RecordedValues::files() const {
  std::vector<std::string> all;
  for (const CompiledProgram& program : programs_)
    for (const std::string& file : files_compiled(program)) all.push_back(file);
  return all;
}

std::string RecordedValues::machine() const {
  if (const auto name = said(recording_.metadata, "machine"))
    return recorded_machine(*name, {recording_.source.name()});
  return programs_.front().compilation.directives.machine ? machine_name(programs_.front(), std::nullopt) : "";
}

Diagnosis RecordedValues::diagnosis(const Machine& machine, const DiagnoseOptions& how) const {
  std::vector<ValueProgram> programs;
  for (std::size_t k = 0; k < programs_.size(); ++k) {
    const CompiledProgram& p = programs_[k];
    const plan::Plan& plan = p.compilation.plan;
    programs.push_back({names_[k], &plan, &p.source, placement_of(p, machine).shift_mm});
  }
  return diagnose_values(recording_, programs, machine, how);
}

}  // namespace abbe
