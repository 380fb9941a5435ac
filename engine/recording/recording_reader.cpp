#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "engine/base/csv.hpp"
#include "engine/base/numbers.hpp"
#include "engine/recording/recording.hpp"

namespace abbe {

namespace {

/// The coordinates of the vectors of a row, which come column by column.
struct PartialVector {
  std::array<std::optional<double>, 3> coordinate;
  int given() const {
    return static_cast<int>(
        std::count_if(coordinate.begin(), coordinate.end(), [](const auto& c) { return c.has_value(); }));
  }
  std::optional<Vec3> complete() const {
    return given() == 3 ? std::optional(Vec3{*coordinate[0], *coordinate[1], *coordinate[2]}) : std::nullopt;
  }
};

/// A row as it is read.
struct Draft {
  RecordingRow row;
  std::map<std::string, PartialVector> vectors;  ///< by the names of their columns: "x,y,z"
};

/// Puts a field into a draft. Returns what the column holds when the field is not that, else "".
using Setter = std::function<std::string(const CsvField&, Draft&)>;

/// From `low` to `high`: beyond is no measurement but a slip, or the mark of a missing value.
template <class Member>
Setter real(Member member, double low, double high) {
  return [=](const CsvField& f, Draft& d) -> std::string {
    const std::optional<double> v = finite_number(f.text);
    if (!v || *v < low || *v > high)
      return fmt::format("a number from {:g} to {:g}, with a decimal point and no unit", low, high);
    d.row.*member = *v;
    return "";
  };
}

template <class Member>
Setter temperature(Member member) {
  return real(member, -50, 150);
}

constexpr int kMostCount = 100'000'000;

template <class Member>
Setter integer(Member member, int least = -kMostCount) {
  return [=](const CsvField& f, Draft& d) -> std::string {
    const std::optional<double> v = finite_number(f.text);
    if (!v || *v != std::floor(*v) || *v < least || *v > kMostCount)
      return least == 1 ? "a whole number from 1" : "a whole number";
    d.row.*member = static_cast<int>(*v);
    return "";
  };
}

template <class Member>
Setter text(Member member) {
  return [=](const CsvField& f, Draft& d) {
    d.row.*member = f.text;
    return f.text.empty() ? "a label" : "";
  };
}

Setter coordinate(std::string vector, int axis) {
  return [=](const CsvField& f, Draft& d) {
    constexpr double kNoMachine_mm = 1e9;  // not even in micrometres
    const std::optional<double> v = finite_number(f.text);
    if (!v || std::abs(*v) > kNoMachine_mm) return "a number in mm, with a decimal point and no unit";
    d.vectors[vector].coordinate[axis] = *v;
    return "";
  };
}

struct VectorColumns {
  std::array<const char*, 3> names;
  const char* key;
};
constexpr VectorColumns kVectors[] = {{{"x", "y", "z"}, "x,y,z"},
                                      {{"tx", "ty", "tz"}, "tx,ty,tz"},
                                      {{"nx", "ny", "nz"}, "nx,ny,nz"},
                                      {{"ax", "ay", "az"}, "ax,ay,az"},
                                      {{"enc_x", "enc_y", "enc_z"}, "enc_x,enc_y,enc_z"}};

std::map<std::string, Setter> setters() {
  constexpr double kTurn_deg = 360, kEpoch_s = 1e11, kFastest_mm_s = 1e5, kHardest_mm_s2 = 1e7, kHeaviest_kg = 1e6;
  std::map<std::string, Setter> s = {
      {"feature", text(&RecordingRow::feature)},
      {"touch", integer(&RecordingRow::touch, 1)},
      {"setup", integer(&RecordingRow::setup, 1)},
      {"run", integer(&RecordingRow::run, 1)},
      {"sensor", text(&RecordingRow::sensor)},
      {"head_A_deg", real(&RecordingRow::head_a_deg, -kTurn_deg, kTurn_deg)},
      {"head_B_deg", real(&RecordingRow::head_b_deg, -kTurn_deg, kTurn_deg)},
      {"qualification", integer(&RecordingRow::qualification)},
      {"visit", integer(&RecordingRow::visit)},
      {"time_s", real(&RecordingRow::time_s, -kEpoch_s, kEpoch_s)},
      {"speed_mm_s", real(&RecordingRow::speed_mm_s, 0, kFastest_mm_s)},
      {"accel_mm_s2", real(&RecordingRow::accel_mm_s2, -kHardest_mm_s2, kHardest_mm_s2)},
      {"temp_part_C", temperature(&RecordingRow::temp_part_C)},
      {"temp_x_C", temperature(&RecordingRow::temp_x_C)},
      {"temp_y_C", temperature(&RecordingRow::temp_y_C)},
      {"temp_z_C", temperature(&RecordingRow::temp_z_C)},
      {"temp_air_C", temperature(&RecordingRow::temp_air_C)},
      {"load_kg", real(&RecordingRow::load_kg, 0, kHeaviest_kg)},
  };
  for (const VectorColumns& v : kVectors)
    for (int axis = 0; axis < 3; ++axis) s[v.names[axis]] = coordinate(v.key, axis);
  return s;
}

/// Whether a line says `yes`; the other thing that it may say is `no`.
bool says(const CsvRemark& line, std::string_view yes, std::string_view no, const SourceFile& file) {
  if (line.value == yes || line.value == no) return line.value == yes;
  throw UserError(diagnostic_at(
      file, line.span, Code::E0525, fmt::format("'{}: {}' is neither '{}' nor '{}'", line.key, line.value, no, yes),
      "correct the line, or leave it out: docs/formats.md, \"Recordings\", says what holds then"));
}

void check_distance(const CsvRemark& line, const SourceFile& file) {
  const std::optional<double> distance = finite_number(line.value);
  constexpr double kFarthest_mm = 1e4;
  if (!distance || *distance < 0 || *distance > kFarthest_mm)
    throw UserError(diagnostic_at(file, line.span, Code::E0525,
                                  fmt::format("'{}: {}' is no distance", line.key, line.value),
                                  "give millimetres, 0 to 10000: 3.5"));
}

Recording with_metadata(const CsvTable& table, const SourceFile& file) {
  Recording recording;
  for (const CsvRemark& line : table.remarks) {
    if (line.key == "frame")
      recording.in_part_frame = says(line, "part", "mcs", file);
    else if (line.key == "point")
      recording.point = says(line, "surface", "tip_centre", file) ? RecordedPoint::surface : RecordedPoint::tip_centre;
    else
      recording.metadata.emplace_back(line.key, line.value);
    if (line.key == "approach_mm" || line.key == "retract_mm") check_distance(line, file);
    if (line.key == "temperature_compensation") says(line, "on", "off", file);
  }
  return recording;
}

/// The setter of each column. An unknown column is an error: a misspelt covariate would silently be lost.
std::vector<Setter> setters_of(const CsvTable& table, const SourceFile& file, Sink& sink) {
  const std::map<std::string, Setter> known = setters();
  std::vector<std::string_view> names;
  for (const auto& [name, setter] : known) names.push_back(name);
  std::vector<Setter> columns;
  std::map<std::string, bool> present;
  for (const CsvField& field : table.header) {
    present[field.text] = true;
    const auto found = known.find(field.text);
    columns.push_back(found == known.end() ? Setter{} : found->second);
    if (columns.back()) continue;
    const std::string near = nearest_word(field.text, names);
    sink.add(diagnostic_at(file, field.span, Code::E0526, fmt::format("a recording has no column '{}'", field.text),
                           near.empty() ? fmt::format("its columns are: {}", fmt::join(names, ", "))
                                        : fmt::format("did you mean '{}'?", near),
                           near));
  }
  for (const char* name : {"feature", "touch", "x", "y", "z"})
    if (!present[name])
      sink.add(diagnostic_at(
          file, table.header.front().span, Code::E0527, fmt::format("the column '{}' is missing", name),
          "a recording needs feature, touch, x, y, z; docs/formats.md, \"Recordings\", lists the others"));
  return columns;
}

void complete_vectors(const SourceFile& file, const CsvRow& row, Draft& draft, Sink& sink) {
  const auto take = [&](const VectorColumns& columns) -> std::optional<Vec3> {
    const PartialVector& v = draft.vectors[columns.key];
    if (v.given() == 1 || v.given() == 2)
      sink.add(diagnostic_at(file, row.fields.front().span, Code::E0528,
                             fmt::format("of {} only {} of three values are given", columns.key, v.given()),
                             "give all three, or none"));
    return v.complete();
  };
  const std::optional<Vec3> position = take(kVectors[0]);
  if (position)
    draft.row.position_mm = *position;
  else if (draft.vectors[kVectors[0].key].given() == 0)
    sink.add(diagnostic_at(file, row.fields.front().span, Code::E0528, "the recorded position is missing",
                           "remove the row, or give x, y, z"));
  draft.row.target_mm = take(kVectors[1]);
  draft.row.normal = take(kVectors[2]);
  draft.row.travel = take(kVectors[3]);
  draft.row.reading_mm = take(kVectors[4]);
  for (std::optional<Vec3>* direction : {&draft.row.normal, &draft.row.travel}) {
    if (!*direction) continue;
    const double length = norm(**direction);
    if (std::abs(length - 1) > 1e-2)
      sink.add(diagnostic_at(file, row.fields.front().span, Code::E0529,
                             fmt::format("a direction of length {:.4g} stands here", length),
                             "nx,ny,nz and ax,ay,az are unit vectors"));
    else
      *direction = **direction / length;
  }
}

}  // namespace

Recording read_recording(const SourceFile& file) {
  const CsvTable table = read_csv(file);
  Recording recording = with_metadata(table, file);
  Sink sink;
  const std::vector<Setter> columns = setters_of(table, file, sink);
  if (sink.has_errors()) throw UserError(sink.list());
  for (const CsvRow& row : table.rows) {
    Draft draft;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const CsvField& field = row.fields[k];
      const bool required = table.header[k].text == "feature" || table.header[k].text == "touch";
      const std::string holds = field.text.empty() && !required ? "" : columns[k](field, draft);
      if (holds.empty()) continue;
      sink.add(
          diagnostic_at(file, field.span, Code::E0530,
                        fmt::format("'{}' is no value for the column '{}'", field.text, table.header[k].text),
                        fmt::format("it holds {}{}", holds, required ? "" : ", or nothing where it is not known")));
    }
    complete_vectors(file, row, draft, sink);
    draft.row.line = row.line;
    recording.rows.push_back(std::move(draft.row));
    if (sink.list().size() >= kMostCsvMessages) break;
  }
  if (sink.has_errors()) throw UserError(sink.list());
  return recording;
}

bool is_value_recording(const SourceFile& file) {
  const std::vector<CsvField> header = read_csv(file).header;
  return std::any_of(header.begin(), header.end(),
                     [](const CsvField& column) { return column.text == "characteristic"; });
}

}  // namespace abbe
