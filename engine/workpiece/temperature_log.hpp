// Temperatures over time as a data logger writes them: CSV with the header time_s and any of
// temp_part_C, temp_x_C, temp_y_C, temp_z_C, temp_air_C, the columns of recordings. Between two
// lines the temperature runs straight; before the first and after the last it stays. time_s counts
// from the start of the program.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/base/source.hpp"

namespace abbe {

struct TemperatureLog {
  enum Column { part, x, y, z, air };
  static constexpr std::array<std::string_view, 5> kNames{"temp_part_C", "temp_x_C", "temp_y_C", "temp_z_C",
                                                          "temp_air_C"};

  std::vector<double> time_s;                        ///< ascending
  std::array<std::vector<double>, 5> temperature_C;  ///< by Column; empty where the log has no such column

  bool has(Column c) const { return !temperature_C[c].empty(); }
  /// Only for columns that the log has.
  double at(Column, double time_s) const;
};

/// Throws UserError: not a table (csv.hpp), or E0425: unknown or missing column, a field that is not
/// a finite number, times that do not ascend.
TemperatureLog read_temperature_log(const SourceFile&);

}  // namespace abbe
