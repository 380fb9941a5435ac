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

/// A step that is no round number of nanometres, as a third of 10 um, of which all lengths are multiples as far as they are
/// written; 0: there is none of at least 0.1 um. Lengths and their differences, from the smallest on: each tells the step
/// better than those before it, since it is more of them.
double interpolated_step_mm(const std::vector<double>& lengths_mm) {
  constexpr double kLeast_mm = 1e-4, kToNanometres_mm = 0.55e-6, kFiner_mm = 0.55e-7, kWhole = 1e-3;
  constexpr int kMostParts = 50;
  constexpr std::size_t kEnough = 24;  // what fewer lengths and differences have in common may be chance
  const bool to_nanometres = std::all_of(lengths_mm.begin(), lengths_mm.end(), [](double length) {
    return std::abs(1e6 * length - std::round(1e6 * length)) < kWhole;
  });
  const double written = 2 * (to_nanometres ? kToNanometres_mm : kFiner_mm);  // of a difference
  std::vector<double> multiples;
  for (const double length : lengths_mm) multiples.push_back(std::abs(length));
  std::sort(multiples.begin(), multiples.end());
  for (std::size_t i = multiples.size(); i-- > 1;) multiples.push_back(multiples[i] - multiples[i - 1]);
  std::sort(multiples.begin(), multiples.end());
  multiples.erase(multiples.begin(), std::lower_bound(multiples.begin(), multiples.end(), kLeast_mm));
  if (multiples.size() < kEnough) return 0;
  double step = multiples.front(), error = written;
  for (const double length : multiples) {
    int parts = 1;  // of the step so far, each of which may be it
    const auto off = [&] {
      const double part = step / parts;
      return std::abs(length - part * std::round(length / part)) - written - std::round(length / part) * error / parts;
    };
    while (off() > 0 && step >= kLeast_mm * (parts + 1) && parts < kMostParts) ++parts;
    step /= parts, error /= parts;
    const double times = std::round(length / step);
    parts = 1;
    if (off() > 0 || 4 * times * error > step) return 0;
    if (written / times < error) step = length / times, error = written / times;
  }
  return step;
}

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
  constexpr double kLastDigitsPerMm = 1e6, kLeastOfDigits_mm = 1e-5;
  long long step = 0;
  for (const double length : lengths_mm) step = std::gcd(step, std::llround(kLastDigitsPerMm * length));
  if (step == 0 || double(step) >= kLeastOfDigits_mm * kLastDigitsPerMm) return double(step) / kLastDigitsPerMm;
  return std::max(interpolated_step_mm(lengths_mm), double(step) / kLastDigitsPerMm);
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
