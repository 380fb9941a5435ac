#include "engine/workpiece/temperature_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "engine/base/diagnostic.hpp"

namespace abbe {

namespace {

constexpr std::string_view kTime = "time_s";

struct Field {
  std::string_view text;
  Span span;
};

std::vector<Field> fields_of(const SourceFile& file, int line) {
  std::vector<Field> fields;
  const std::string_view text = file.line(line);
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    std::size_t begin = from, end = comma;
    while (begin < end && text[begin] == ' ') ++begin;
    while (end > begin && text[end - 1] == ' ') --end;
    const auto at = file.line_begin(line) + static_cast<std::uint32_t>(begin);
    fields.push_back(
        {text.substr(begin, end - begin), {at, at + static_cast<std::uint32_t>(end - begin)}});
    from = comma + 1;
  }
  return fields;
}

[[noreturn]] void refuse(const SourceFile& file, const Field& at, std::string message,
                         std::string help) {
  throw UserError(diagnostic_at(file, at.span, Code::E0425, std::move(message), std::move(help)));
}

/// Where the values of each field of a line go.
std::vector<std::vector<double>*> read_header(const SourceFile& file, TemperatureLog& log) {
  std::vector<std::vector<double>*> columns;
  const std::vector<Field> header = fields_of(file, 1);
  for (const Field& field : header) {
    const auto name = std::find(log.kNames.begin(), log.kNames.end(), field.text);
    std::vector<double>* column = &log.time_s;
    if (name != log.kNames.end()) {
      column = &log.temperature_C[static_cast<std::size_t>(name - log.kNames.begin())];
    } else if (field.text != kTime) {
      std::vector<std::string_view> known(log.kNames.begin(), log.kNames.end());
      known.push_back(kTime);
      const std::string near = nearest_word(field.text, known);
      refuse(file, field, fmt::format("a temperature log has no column '{}'", field.text),
             near.empty() ? fmt::format("its columns are: {}", fmt::join(known, ", "))
                          : fmt::format("did you mean '{}'?", near));
    }
    if (std::find(columns.begin(), columns.end(), column) != columns.end())
      refuse(file, field, fmt::format("column '{}' stands here for the second time", field.text),
             "remove one of the two");
    columns.push_back(column);
  }
  if (columns.size() < 2 || std::find(columns.begin(), columns.end(), &log.time_s) == columns.end())
    refuse(file, header.front(),
           "a temperature log needs the column 'time_s' and at least one temperature",
           "the first line is for example 'time_s,temp_part_C,temp_air_C'");
  return columns;
}

double number(const SourceFile& file, const Field& field) {
  double value = 0;
  const auto [end, failure] =
      std::from_chars(field.text.data(), field.text.data() + field.text.size(), value);
  if (failure != std::errc{} || end != field.text.data() + field.text.size())
    refuse(file, field, fmt::format("'{}' is not a number", field.text),
           "numbers have a decimal point: 20.15");
  return value;
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
  TemperatureLog log;
  const std::vector<std::vector<double>*> columns = read_header(file, log);
  for (int line = 2; line <= file.line_count(); ++line) {
    const std::vector<Field> fields = fields_of(file, line);
    if (fields.size() == 1 && fields[0].text.empty()) continue;
    if (fields.size() != columns.size())
      refuse(file, fields.front(),
             fmt::format("this line has {} values, the header {} columns", fields.size(),
                         columns.size()),
             "every line holds one value for each column");
    for (std::size_t k = 0; k < fields.size(); ++k) columns[k]->push_back(number(file, fields[k]));
    const std::size_t n = log.time_s.size();
    if (n > 1 && log.time_s[n - 1] <= log.time_s[n - 2])
      refuse(file, fields.front(),
             fmt::format("time_s is {:g} here after {:g}", log.time_s[n - 1], log.time_s[n - 2]),
             "the lines of a log ascend in time");
  }
  if (log.time_s.empty())
    refuse(file, {"", {0, 1}}, "the temperature log has no values", "add a line such as '0,20.1'");
  return log;
}

}  // namespace abbe
