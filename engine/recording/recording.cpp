#include "engine/recording/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/base/csv.hpp"
#include "engine/recording/columns.hpp"

namespace abbe {

namespace {

/// Fixed decimals without a negative zero.
std::string decimals(double value, int digits) {
  std::string text = fmt::format("{:.{}f}", value, digits);
  if (text.find_first_not_of("-0.") == std::string::npos && text.front() == '-') text.erase(0, 1);
  return text;
}

std::string text(const std::string& label, int, int) { return csv_field(label); }
std::string text(int value, int, int) { return std::to_string(value); }
std::string text(double value, int digits, int) { return decimals(value, digits); }
std::string text(const Vec3& v, int digits, int axis) { return decimals(v[axis], digits); }
/// Nothing where it was not logged.
template <class Value>
std::string text(const std::optional<Value>& value, int digits, int axis) {
  return value ? text(*value, digits, axis) : "";
}

std::string on_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

/// A column, of a vector one of three.
struct WrittenColumn {
  const RecordingColumn* column;
  int axis;
  std::string text(const RecordingRow& row) const {
    return std::visit([&](auto member) { return abbe::text(row.*member, column->decimals, axis); }, column->member);
  }
};

}  // namespace

std::optional<Surfaces> find_surfaces(std::string_view word) {
  if (word == "calibrated") return Surfaces::calibrated;
  if (word == "unknown_size") return Surfaces::unknown_size;
  if (word == "unknown") return Surfaces::unknown;
  return std::nullopt;
}

std::string line_of(const Recording& r, const RecordingRow& row) {
  return fmt::format("line {}{}", row.line,
                     r.files.size() > 1 ? " of " + r.files[static_cast<std::size_t>(row.file)] : "");
}

std::optional<std::string> said(const Metadata& metadata, std::string_view key) {
  const auto found =
      std::find_if(metadata.begin(), metadata.end(), [&](const auto& line) { return line.first == key; });
  if (found == metadata.end()) return std::nullopt;
  return found->second;
}

double common_step_mm(const std::vector<double>& lengths_mm) {
  constexpr double kLastDigitsPerMm = 1e6;
  long long step = 0;
  for (const double length : lengths_mm) step = std::gcd(step, std::llround(kLastDigitsPerMm * length));
  return double(step) / kLastDigitsPerMm;
}

double common_step_mm(const Recording& recording) {
  std::vector<double> coordinates;
  for (const RecordingRow& row : recording.rows)
    for (int k = 0; k < 3; ++k) coordinates.push_back(row.position_mm[k]);
  return common_step_mm(coordinates);
}

void round_readings(Recording& recording, double step_mm) {
  const auto round = [&](Vec3& v) {
    for (int k = 0; k < 3; ++k)
      if (const double steps = std::round(v[k] / step_mm); std::isfinite(steps)) v[k] = step_mm * steps;
  };
  for (RecordingRow& row : recording.rows) {
    round(row.position_mm);
    if (row.reading_mm) round(*row.reading_mm);
  }
}

std::string to_csv(const Recording& recording) {
  std::vector<WrittenColumn> columns;
  for (const RecordingColumn& column : recording_columns())
    for (int axis = 0; axis < 3 && !column.names[static_cast<std::size_t>(axis)].empty(); ++axis)
      columns.push_back({&column, axis});
  std::erase_if(columns, [&](const WrittenColumn& column) {
    return std::all_of(recording.rows.begin(), recording.rows.end(),
                       [&](const RecordingRow& row) { return column.text(row).empty(); });
  });
  std::string out;
  for (const auto& [key, value] : recording.metadata) out += fmt::format("# {}: {}\n", key, on_one_line(value));
  out += fmt::format("# frame: {}\n# point: {}\n", recording.in_part_frame ? "part" : "mcs",
                     recording.point == RecordedPoint::surface ? "surface" : "tip_centre");
  std::string separator;
  for (const WrittenColumn& c : columns) {
    out += separator;
    out += c.column->names[static_cast<std::size_t>(c.axis)];
    separator = ",";
  }
  out += "\n";
  for (const RecordingRow& row : recording.rows) {
    for (std::size_t k = 0; k < columns.size(); ++k) out += (k ? "," : "") + columns[k].text(row);
    out += "\n";
  }
  return out;
}

}  // namespace abbe
