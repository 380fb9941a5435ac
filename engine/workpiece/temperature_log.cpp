#include "engine/workpiece/temperature_log.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/base/csv.hpp"
#include "engine/base/limits.hpp"
#include "engine/base/numbers.hpp"

namespace abbe {

namespace {

constexpr std::string_view kTime = "time_s";

[[noreturn]] void refuse(const SourceFile& file, const CsvField& at, std::string message, std::string help) {
  throw UserError(diagnostic_at(file, at.span, Code::E0425, std::move(message), std::move(help)));
}

/// Where the values of each field of a line go.
std::vector<std::vector<double>*> columns_of(const std::vector<CsvField>& header, const SourceFile& file,
                                             TemperatureLog& log) {
  std::vector<std::vector<double>*> columns;
  for (const CsvField& field : header) {
    const auto name = std::find(log.kNames.begin(), log.kNames.end(), field.text);
    std::vector<double>* column = &log.time_s;
    if (name != log.kNames.end()) {
      column = &log.temperature_C[static_cast<std::size_t>(name - log.kNames.begin())];
    } else if (field.text != kTime) {
      std::vector<std::string_view> known(log.kNames.begin(), log.kNames.end());
      known.push_back(kTime);
      refuse(file, field, fmt::format("a temperature log has no column '{}'", field.text),
             column_help(field.text, known));
    }
    columns.push_back(column);
  }
  if (columns.size() < 2 || std::find(columns.begin(), columns.end(), &log.time_s) == columns.end())
    refuse(file, header.front(), "a temperature log needs the column 'time_s' and at least one temperature",
           "the first line is for example 'time_s,temp_part_C,temp_air_C'");
  return columns;
}

double number(const SourceFile& file, const CsvField& field, double low, double high) {
  const std::optional<double> value = finite_number(field.text);
  if (!value)
    refuse(file, field, fmt::format("'{}' is not a number", field.text), "numbers have a decimal point: 20.15");
  if (*value < low || *value > high)
    refuse(
        file, field, fmt::format("{} is not between {:g} and {:g}", field.text, low, high),
        "times are in seconds, temperatures in degrees Celsius; leave out lines of which a temperature is not known");
  return *value;
}

}  // namespace

double TemperatureLog::at(Column c, double time) const {
  const std::vector<double>& value = temperature_C[c];
  const auto after = std::upper_bound(time_s.begin(), time_s.end(), time) - time_s.begin();
  if (after == 0) return value.front();
  if (after == static_cast<std::ptrdiff_t>(time_s.size())) return value.back();
  const double share = (time - time_s[after - 1]) / (time_s[after] - time_s[after - 1]);
  return value[after - 1] + share * (value[after] - value[after - 1]);
}

TemperatureLog read_temperature_log(const SourceFile& file) {
  const CsvTable table = read_csv(file);
  TemperatureLog log;
  const std::vector<std::vector<double>*> columns = columns_of(table.header, file, log);
  for (const CsvRow& row : table.rows) {
    for (std::size_t k = 0; k < columns.size(); ++k)
      columns[k]->push_back(columns[k] == &log.time_s ? number(file, row.fields[k], -kLatest_s, kLatest_s)
                                                      : number(file, row.fields[k], kColdest_C, kHottest_C));
    const std::size_t n = log.time_s.size();
    if (n > 1 && log.time_s[n - 1] <= log.time_s[n - 2])
      refuse(file, row.fields.front(),
             fmt::format("time_s is {:g} here after {:g}", log.time_s[n - 1], log.time_s[n - 2]),
             "the lines of a log ascend in time");
  }
  return log;
}

}  // namespace abbe
