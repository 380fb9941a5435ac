#include "engine/recording/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "engine/base/csv.hpp"

namespace abbe {

namespace {

/// One column: its name, and the text of a row's value or nothing.
struct WrittenColumn {
  std::string name;
  std::function<std::optional<std::string>(const RecordingRow&)> text;
};

/// Fixed decimals without a negative zero.
std::string decimals(double value, int digits) {
  std::string text = fmt::format("{:.{}f}", value, digits);
  if (text.find_first_not_of("-0.") == std::string::npos && text.front() == '-') text.erase(0, 1);
  return text;
}

WrittenColumn number(std::string name, int digits, std::function<std::optional<double>(const RecordingRow&)> value) {
  return {std::move(name), [=](const RecordingRow& row) -> std::optional<std::string> {
            const std::optional<double> v = value(row);
            return v ? std::optional(decimals(*v, digits)) : std::nullopt;
          }};
}

void add_vector(std::vector<WrittenColumn>& columns, const std::array<const char*, 3>& names, int digits,
                std::function<std::optional<Vec3>(const RecordingRow&)> value) {
  for (int axis = 0; axis < 3; ++axis)
    columns.push_back(number(names[axis], digits, [=](const RecordingRow& row) -> std::optional<double> {
      const std::optional<Vec3> v = value(row);
      return v ? std::optional((*v)[axis]) : std::nullopt;
    }));
}

std::vector<WrittenColumn> writable_columns() {
  std::vector<WrittenColumn> c;
  const auto integer = [&](const char* name, auto member) {
    c.push_back({name, [=](const RecordingRow& row) -> std::optional<std::string> {
                   const std::optional<int> v = row.*member;
                   return v ? std::optional(std::to_string(*v)) : std::nullopt;
                 }});
  };
  c.push_back({"feature", [](const RecordingRow& row) { return std::optional(csv_field(row.feature)); }});
  integer("touch", &RecordingRow::touch);
  add_vector(c, {"x", "y", "z"}, 7, [](const RecordingRow& row) { return std::optional(row.position_mm); });
  add_vector(c, {"tx", "ty", "tz"}, 7, [](const RecordingRow& row) { return row.target_mm; });
  add_vector(c, {"nx", "ny", "nz"}, 9, [](const RecordingRow& row) { return row.normal; });
  integer("setup", &RecordingRow::setup);
  integer("run", &RecordingRow::run);
  c.push_back({"sensor", [](const RecordingRow& row) {
                 return row.sensor ? std::optional(csv_field(*row.sensor)) : std::nullopt;
               }});
  c.push_back(number("head_A_deg", 4, [](const RecordingRow& row) { return row.head_a_deg; }));
  c.push_back(number("head_B_deg", 4, [](const RecordingRow& row) { return row.head_b_deg; }));
  integer("qualification", &RecordingRow::qualification);
  integer("visit", &RecordingRow::visit);
  c.push_back(number("time_s", 3, [](const RecordingRow& row) { return row.time_s; }));
  c.push_back(number("speed_mm_s", 4, [](const RecordingRow& row) { return row.speed_mm_s; }));
  c.push_back(number("accel_mm_s2", 2, [](const RecordingRow& row) { return row.accel_mm_s2; }));
  add_vector(c, {"ax", "ay", "az"}, 9, [](const RecordingRow& row) { return row.travel; });
  c.push_back(number("temp_part_C", 3, [](const RecordingRow& row) { return row.temp_part_C; }));
  c.push_back(number("temp_x_C", 3, [](const RecordingRow& row) { return row.temp_x_C; }));
  c.push_back(number("temp_y_C", 3, [](const RecordingRow& row) { return row.temp_y_C; }));
  c.push_back(number("temp_z_C", 3, [](const RecordingRow& row) { return row.temp_z_C; }));
  c.push_back(number("temp_air_C", 3, [](const RecordingRow& row) { return row.temp_air_C; }));
  c.push_back(number("load_kg", 3, [](const RecordingRow& row) { return row.load_kg; }));
  add_vector(c, {"enc_x", "enc_y", "enc_z"}, 7, [](const RecordingRow& row) { return row.reading_mm; });
  return c;
}

}  // namespace

std::optional<std::string> said(const Metadata& metadata, std::string_view key) {
  const auto found =
      std::find_if(metadata.begin(), metadata.end(), [&](const auto& line) { return line.first == key; });
  if (found == metadata.end()) return std::nullopt;
  return found->second;
}

double common_step_mm(const Recording& recording) {
  constexpr double kLastDigitsPerMm = 1e6;
  long long step = 0;
  for (const RecordingRow& row : recording.rows)
    for (int k = 0; k < 3; ++k) step = std::gcd(step, std::llround(kLastDigitsPerMm * row.position_mm[k]));
  return double(step) / kLastDigitsPerMm;
}

std::string to_csv(const Recording& recording) {
  std::vector<WrittenColumn> columns = writable_columns();
  std::erase_if(columns, [&](const WrittenColumn& column) {
    for (const RecordingRow& row : recording.rows)
      if (column.text(row)) return false;
    return true;
  });
  std::string out;
  for (const auto& [key, value] : recording.metadata) out += fmt::format("# {}: {}\n", key, value);
  out += fmt::format("# frame: {}\n# point: {}\n", recording.in_part_frame ? "part" : "mcs",
                     recording.point == RecordedPoint::surface ? "surface" : "tip_centre");
  for (std::size_t k = 0; k < columns.size(); ++k) out += (k ? "," : "") + columns[k].name;
  out += "\n";
  for (const RecordingRow& row : recording.rows) {
    for (std::size_t k = 0; k < columns.size(); ++k) out += (k ? "," : "") + columns[k].text(row).value_or("");
    out += "\n";
  }
  return out;
}

}  // namespace abbe
