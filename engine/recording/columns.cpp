#include "engine/recording/columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/base/limits.hpp"

namespace abbe {

std::span<const RecordingColumn> recording_columns() {
  using Row = RecordingRow;
  constexpr double kCount = 1e8, kFar_mm = 1e9 /* not even in micrometres */;
  constexpr double kFastest_mm_s = 1e5, kHardest_mm_s2 = 1e7, kHeaviest_kg = 1e6;
  const auto counted = [](std::string_view name, RecordingColumn::Member member) {
    return RecordingColumn{.names = {name}, .member = member, .low = 1, .high = kCount};
  };
  const auto numbered = [](std::string_view name, RecordingColumn::Member member) {
    return RecordingColumn{.names = {name}, .member = member, .low = -kCount, .high = kCount};
  };
  const auto lengths = [](std::array<std::string_view, 3> names, RecordingColumn::Member member) {
    return RecordingColumn{.names = names, .member = member, .low = -kFar_mm, .high = kFar_mm, .decimals = 7};
  };
  const auto direction = [](std::array<std::string_view, 3> names, RecordingColumn::Member member) {
    return RecordingColumn{
        .names = names, .member = member, .low = -kFar_mm, .high = kFar_mm, .decimals = 9, .unit_vector = true};
  };
  const auto angle = [](std::string_view name, RecordingColumn::Member member) {
    return RecordingColumn{
        .names = {name}, .member = member, .low = kTurn_deg.low, .high = kTurn_deg.high, .decimals = 4};
  };
  const auto temperature = [](std::string_view name, RecordingColumn::Member member) {
    return RecordingColumn{
        .names = {name}, .member = member, .low = kColdest_C, .high = kHottest_C, .decimals = 3, .changes = true};
  };
  const auto required = [](RecordingColumn column) {
    column.required = true;
    return column;
  };
  const auto changing = [](RecordingColumn column) {
    column.changes = true;
    return column;
  };

  static const RecordingColumn columns[] = {
      required({.names = {"feature"}, .member = &Row::feature}),
      required(counted("touch", &Row::touch)),
      required(lengths({"x", "y", "z"}, &Row::position_mm)),
      lengths({"tx", "ty", "tz"}, &Row::target_mm),
      direction({"nx", "ny", "nz"}, &Row::normal),
      counted("setup", &Row::setup),
      counted("run", &Row::run),
      {.names = {"sensor"}, .member = &Row::sensor},
      angle("head_A_deg", &Row::head_a_deg),
      angle("head_B_deg", &Row::head_b_deg),
      numbered("qualification", &Row::qualification),
      numbered("visit", &Row::visit),
      changing({.names = {"time_s"}, .member = &Row::time_s, .low = -kLatest_s, .high = kLatest_s, .decimals = 3}),
      changing({.names = {"speed_mm_s"}, .member = &Row::speed_mm_s, .high = kFastest_mm_s, .decimals = 4}),
      changing({.names = {"accel_mm_s2"},
                .member = &Row::accel_mm_s2,
                .low = -kHardest_mm_s2,
                .high = kHardest_mm_s2,
                .decimals = 2}),
      changing(direction({"ax", "ay", "az"}, &Row::travel)),
      temperature("temp_part_C", &Row::temp_part_C),
      temperature("temp_x_C", &Row::temp_x_C),
      temperature("temp_y_C", &Row::temp_y_C),
      temperature("temp_z_C", &Row::temp_z_C),
      temperature("temp_air_C", &Row::temp_air_C),
      changing({.names = {"load_kg"}, .member = &Row::load_kg, .high = kHeaviest_kg, .decimals = 3}),
      changing(lengths({"enc_x", "enc_y", "enc_z"}, &Row::reading_mm)),
  };
  return columns;
}

std::string name(const RecordingColumn& column) {
  return column.names[1].empty() ? std::string(column.names[0]) : fmt::format("{}", fmt::join(column.names, ","));
}

}  // namespace abbe
