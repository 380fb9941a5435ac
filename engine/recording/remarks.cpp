#include "engine/recording/remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "engine/base/numbers.hpp"
#include "engine/recording/sensor_line.hpp"

namespace abbe {

namespace {

constexpr std::string_view kRead[] = {
    "frame", "point", "machine", "workpiece", "approach_mm", "retract_mm", "temperature_compensation", "surfaces"};
constexpr std::string_view kForPeople[] = {"program", "seed", "effects", "made_by", "artefact"};

template <class List>
bool has(const List& list, std::string_view key) {
  return std::find(std::begin(list), std::end(list), key) != std::end(list);
}

bool same(const std::string& value, const std::string& other) {
  const std::optional<double> number = finite_number(value);
  return value == other || (number && number == finite_number(other));
}

void refuse_contradiction(const CsvRemark& first, const CsvRemark& line, const SourceFile& file) {
  if (same(first.value, line.value)) return;
  throw UserError(
      diagnostic_at(file, line.span, Code::E0532,
                    fmt::format("'{}: {}' contradicts line {}, '{}: {}'", line.key, line.value,
                                file.place(first.span.begin).line, first.key, first.value),
                    "keep the line that holds for all rows; rows of which another holds need another file"));
}

/// The key that a line of another key means; "" where it is free text. A stylus line is known by its words.
std::string meant(const CsvRemark& line) {
  if (has(kRead, line.key) || has(kForPeople, line.key) || line.key.starts_with(kSensorKey)) return "";
  if (line.value.find("tip_in_r_mm") != std::string::npos) return "sensor NAME";
  return nearest_word(line.key, {std::begin(kRead), std::end(kRead)});
}

}  // namespace

std::vector<Diagnostic> check_remarks(const CsvTable& table, const SourceFile& file) {
  std::vector<Diagnostic> doubts;
  std::map<std::string_view, const CsvRemark*> first;
  for (const CsvRemark& line : table.remarks) {
    if (has(kRead, line.key)) refuse_contradiction(*first.emplace(line.key, &line).first->second, line, file);
    if (const std::string near = meant(line); !near.empty())
      doubts.push_back(diagnostic_at(file, line.span, Code::W0533,
                                     fmt::format("no key '{}' is read: this line counts as free text", line.key),
                                     fmt::format("did you mean '# {}:'?", near)));
  }
  return doubts;
}

}  // namespace abbe
