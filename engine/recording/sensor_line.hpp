// What a line `# sensor NAME: head_deg A B tip_in_r_mm x y z diameter_mm d ...` of a recording says: words of a machine
// file, each with its numbers and the same limits.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace abbe {

/// Of its key; the name of the stylus follows.
inline constexpr std::string_view kSensorKey = "sensor ";

struct SensorLine {
  std::map<std::string_view, std::vector<double>> numbers;  ///< by word, in the unit of its name
  std::string mistake;                                      ///< why it cannot be read; "": it can

  /// The numbers of a word, or what holds when the line does not say it.
  std::vector<double> numbers_or(std::string_view word, std::vector<double> otherwise) const;
  double number_or(std::string_view word, double otherwise) const { return numbers_or(word, {otherwise})[0]; }
};

/// `value`: what stands behind the key.
SensorLine read_sensor_line(const std::string& value);

/// The next step where it cannot be read.
inline constexpr const char* kSensorLineHelp =
    "write head_deg A B tip_in_r_mm x y z diameter_mm d, numbers between blanks";

}  // namespace abbe
