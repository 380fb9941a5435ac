#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <variant>

#include "engine/base/csv.hpp"
#include "engine/base/numbers.hpp"
#include "engine/recording/columns.hpp"
#include "engine/recording/remarks.hpp"
#include "engine/recording/sensor_line.hpp"

namespace abbe {

namespace {

/// The coordinates of a vector of a row, which come column by column.
using PartialVector = std::array<std::optional<double>, 3>;

/// A row as it is read: what is not yet in it are vectors, by their place in the list of columns.
struct Draft {
  RecordingRow row;
  std::map<std::size_t, PartialVector> vectors;
};

/// A column of the file: which of the list it is, of a vector with which coordinate.
struct FileColumn {
  std::size_t place = 0;
  int axis = 0;
};

const RecordingColumn& described(const FileColumn& read) { return recording_columns()[read.place]; }

std::map<std::string_view, FileColumn> columns_by_name() {
  std::map<std::string_view, FileColumn> out;
  for (std::size_t place = 0; place < recording_columns().size(); ++place)
    for (int axis = 0; axis < 3; ++axis)
      if (const std::string_view name = recording_columns()[place].names[static_cast<std::size_t>(axis)]; !name.empty())
        out[name] = {place, axis};
  return out;
}

/// The number that a field is, within the limits of its column.
std::optional<double> number(const CsvField& f, const RecordingColumn& column) {
  const std::optional<double> v = finite_number(f.text);
  return v && column.low <= *v && *v <= column.high ? v : std::nullopt;
}

/// Puts a field into a draft, by the type of its member. Returns what the column holds when the field is not that, else "".
struct Put {
  const CsvField& field;
  const FileColumn& read;
  Draft& draft;

  std::string operator()(std::string RecordingRow::*member) const { return label(member); }
  std::string operator()(std::optional<std::string> RecordingRow::*member) const { return label(member); }
  std::string operator()(int RecordingRow::*member) const { return integer(member); }
  std::string operator()(std::optional<int> RecordingRow::*member) const { return integer(member); }
  std::string operator()(std::optional<double> RecordingRow::*member) const {
    const RecordingColumn& column = described(read);
    draft.row.*member = number(field, column);
    if (draft.row.*member) return "";
    return member == &RecordingRow::time_s
        ? "seconds from any moment on, with a decimal point and no unit: 08:00:10.02 is 28810.02"
        : fmt::format("a number from {:g} to {:g}, with a decimal point and no unit", column.low, column.high);
  }
  std::string operator()(Vec3 RecordingRow::*) const { return coordinate(); }
  std::string operator()(std::optional<Vec3> RecordingRow::*) const { return coordinate(); }

 private:
  template <class Member>
  std::string label(Member member) const {
    draft.row.*member = field.text;
    return field.text.empty() ? "a label" : "";
  }
  template <class Member>
  std::string integer(Member member) const {
    const std::optional<double> v = number(field, described(read));
    if (!v || *v != std::floor(*v)) return described(read).low == 1 ? "a whole number from 1" : "a whole number";
    draft.row.*member = static_cast<int>(*v);
    return "";
  }
  std::string coordinate() const {
    const std::optional<double> v = number(field, described(read));
    draft.vectors[read.place][static_cast<std::size_t>(read.axis)] = v;
    if (v) return "";
    const RecordingColumn& column = described(read);
    return column.unit_vector
        ? "a number, with a decimal point"
        : fmt::format("a number in mm from {:g} to {:g}, with a decimal point and no unit", column.low, column.high);
  }
};

/// Whether a line says `yes`; the other thing that it may say is `no`.
bool says(const CsvRemark& line, std::string_view yes, std::string_view no, const SourceFile& file) {
  if (line.value == yes || line.value == no) return line.value == yes;
  throw UserError(diagnostic_at(
      file, line.span, Code::E0525, fmt::format("'{}: {}' is neither '{}' nor '{}'", line.key, line.value, no, yes),
      "correct the line, or leave it out: docs/recording.md, \"Recordings\", says what holds then"));
}

void check_distance(const CsvRemark& line, const SourceFile& file) {
  const std::optional<double> distance = finite_number(line.value);
  constexpr double kFarthest_mm = 1e4;
  if (!distance || *distance < 0 || *distance > kFarthest_mm)
    throw UserError(diagnostic_at(file, line.span, Code::E0525,
                                  fmt::format("'{}: {}' is no distance", line.key, line.value),
                                  "give millimetres, 0 to 10000: 3.5"));
}

void check_surfaces(const CsvRemark& line, const SourceFile& file) {
  if (!find_surfaces(line.value))
    throw UserError(diagnostic_at(file, line.span, Code::E0703,
                                  fmt::format("'{}: {}' is not known", line.key, line.value),
                                  "write calibrated, unknown_size or unknown"));
}

void check_sensor(const CsvRemark& line, const SourceFile& file) {
  if (const std::string mistake = read_sensor_line(line.value).mistake; !mistake.empty())
    throw UserError(diagnostic_at(file, line.span, Code::E0545,
                                  fmt::format("'{}' cannot be read: {}", line.key, mistake), kSensorLineHelp));
}

Recording with_metadata(const CsvTable& table, const SourceFile& file) {
  Recording recording;
  recording.messages = check_remarks(table, file);
  for (const CsvRemark& line : table.remarks) {
    if (line.key == "frame")
      recording.in_part_frame = says(line, "part", "mcs", file);
    else if (line.key == "point")
      recording.point = says(line, "surface", "tip_centre", file) ? RecordedPoint::surface : RecordedPoint::tip_centre;
    else
      recording.metadata.emplace_back(line.key, line.value);
    if (line.key == "approach_mm" || line.key == "retract_mm") check_distance(line, file);
    if (line.key == "temperature_compensation") says(line, "on", "off", file);
    if (line.key == "surfaces") check_surfaces(line, file);
    if (line.key.starts_with(kSensorKey)) check_sensor(line, file);
  }
  return recording;
}

bool is_position(const RecordingColumn& column) {
  const auto* vector = std::get_if<Vec3 RecordingRow::*>(&column.member);
  return vector && *vector == &RecordingRow::position_mm;
}

/// What each column of the file is. An unknown one is an error: a misspelt covariate would silently be lost.
std::vector<FileColumn> columns_of(const CsvTable& table, const SourceFile& file, Positions positions, Sink& sink) {
  const std::map<std::string_view, FileColumn> known = columns_by_name();
  std::vector<std::string_view> names;
  for (const auto& [name, column] : known) names.push_back(name);
  std::vector<FileColumn> columns;
  std::set<std::string_view> present;
  for (const CsvField& field : table.header) {
    present.insert(field.text);
    const auto found = known.find(field.text);
    columns.push_back(found == known.end() ? FileColumn{} : found->second);
    if (found != known.end()) continue;
    const std::string near = nearest_word(field.text, names);
    sink.add(diagnostic_at(file, field.span, Code::E0526, fmt::format("a recording has no column '{}'", field.text),
                           column_help(field.text, names), differ_in_unit(field.text, near) ? "" : near));
  }
  for (const RecordingColumn& column : recording_columns())
    for (const std::string_view name : column.names)
      if (column.required && !(is_position(column) && positions == Positions::or_targets) && !name.empty() &&
          !present.contains(name))
        sink.add(diagnostic_at(
            file, table.header.front().span, Code::E0527, fmt::format("the column '{}' is missing", name),
            is_position(column) && present.contains("tx")
                ? "a recording needs the measured x, y, z; what a plan of targets could tell, --design-only says"
                : "a recording needs feature, touch, x, y, z; docs/recording.md, \"Recordings\", lists the others"));
  return columns;
}

/// The vector of three coordinates; nothing where none is given.
std::optional<Vec3> complete(const PartialVector& v, const RecordingColumn& column, const SourceFile& file,
                             const CsvRow& row, Sink& sink, bool required) {
  const auto given = std::count_if(v.begin(), v.end(), [](const auto& coordinate) { return coordinate.has_value(); });
  const Span place = row.fields.front().span;
  if (given == 1 || given == 2)
    sink.add(diagnostic_at(file, place, Code::E0528,
                           fmt::format("of {} only {} of three values are given", name(column), given),
                           "give all three, or none"));
  else if (given == 0 && required)
    sink.add(diagnostic_at(file, place, Code::E0528, "the recorded position is missing",
                           "remove the row, or give x, y, z; a plan (--design-only) may give tx, ty, tz instead"));
  if (given < 3) return std::nullopt;
  const Vec3 all{*v[0], *v[1], *v[2]};
  if (!column.unit_vector) return all;
  const double length = norm(all);
  if (std::abs(length - 1) > 1e-2)
    sink.add(diagnostic_at(file, place, Code::E0529, fmt::format("a direction of length {:.4g} stands here", length),
                           "nx,ny,nz and ax,ay,az are unit vectors"));
  return all / length;
}

void complete_vectors(const SourceFile& file, const CsvRow& row, Positions positions, Draft& draft, Sink& sink) {
  const auto vector = [&](std::size_t place, bool required) {
    return complete(draft.vectors[place], recording_columns()[place], file, row, sink, required);
  };
  std::optional<std::size_t> position;
  for (std::size_t place = 0; place < recording_columns().size(); ++place) {
    const RecordingColumn& column = recording_columns()[place];
    if (is_position(column))
      position = place;
    else if (const auto* given = std::get_if<Vec3 RecordingRow::*>(&column.member))
      draft.row.*(*given) = vector(place, column.required).value_or(Vec3{});
    else if (const auto* logged = std::get_if<std::optional<Vec3> RecordingRow::*>(&column.member))
      draft.row.*(*logged) = vector(place, column.required);
  }
  const std::optional<Vec3> instead = positions == Positions::or_targets ? draft.row.target_mm : std::nullopt;
  const std::optional<Vec3> recorded = vector(*position, !instead);
  draft.row.position_mm = recorded.value_or(instead.value_or(Vec3{}));
}

}  // namespace

Recording read_recording(const SourceFile& file, Positions positions) {
  const CsvTable table = read_csv(file);
  Recording recording = with_metadata(table, file);
  Sink sink;
  const std::vector<FileColumn> columns = columns_of(table, file, positions, sink);
  if (sink.has_errors()) throw UserError(sink.list());
  for (const CsvRow& row : table.rows) {
    Draft draft;
    bool understood = true;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const CsvField& field = row.fields[k];
      const RecordingColumn& column = described(columns[k]);
      const bool required = column.required && column.names[1].empty();  // what of a vector is missing is told with it
      if (field.text.empty() && !required) continue;
      const std::string holds = std::visit(Put{field, columns[k], draft}, column.member);
      if (holds.empty()) continue;
      understood = false;
      sink.add(
          diagnostic_at(file, field.span, Code::E0530,
                        fmt::format("'{}' is no value for the column '{}'", field.text, table.header[k].text),
                        fmt::format("it holds {}{}", holds, required ? "" : ", or nothing where it is not known")));
    }
    if (understood) complete_vectors(file, row, positions, draft, sink);
    draft.row.line = row.line;
    recording.rows.push_back(std::move(draft.row));
    if (sink.list().size() >= kMostCsvMessages) break;
  }
  if (sink.has_errors()) throw UserError(sink.list());
  return recording;
}

bool is_value_recording(const SourceFile& file) {
  const std::vector<CsvField> header = read_csv(file).header;
  const auto has = [&](std::string_view name) {
    return std::any_of(header.begin(), header.end(), [&](const CsvField& column) { return column.text == name; });
  };
  return has("characteristic") || (has("value") && !has("x") && !has("y") && !has("z"));
}

}  // namespace abbe
