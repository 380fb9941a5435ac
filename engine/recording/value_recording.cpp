#include "engine/recording/value_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>

#include "engine/base/csv.hpp"
#include "engine/base/letter_case.hpp"
#include "engine/base/numbers.hpp"
#include "engine/recording/remarks.hpp"

namespace abbe {

namespace {

struct ReadColumn {
  std::string_view name;
  std::function<bool(const CsvField&, ValueRow&)> set;  ///< false: not a value of this column
  bool required = false;
};

bool set_number(const CsvField& f, const std::function<void(double)>& set) {
  const std::optional<double> v = finite_number(f.text);
  if (v) set(*v);
  return v.has_value();
}

bool set_count(const CsvField& f, int& to) {
  const std::optional<double> v = finite_number(f.text);
  constexpr double kMost = 1e6;
  if (!v || *v != std::floor(*v) || *v < 1 || *v > kMost) return false;
  to = static_cast<int>(*v);
  return true;
}

const std::vector<ReadColumn>& readable_columns() {
  static const std::vector<ReadColumn> all = {
      {"characteristic",
       [](const CsvField& f, ValueRow& r) {
         r.characteristic = f.text, r.span = f.span;
         return true;
       },
       true},
      {"value",
       [](const CsvField& f, ValueRow& r) {
         return set_number(f, [&](double v) { r.value = v, r.last_digit = last_digit(f.text); });
       },
       true},
      {"reference", [](const CsvField& f, ValueRow& r) { return set_number(f, [&](double v) { r.reference = v; }); }},
      {"U",
       [](const CsvField& f, ValueRow& r) {
         return set_number(f, [&](double v) { r.expanded_uncertainty = v; }) && r.expanded_uncertainty >= 0;
       }},
      {"run", [](const CsvField& f, ValueRow& r) { return set_count(f, r.run); }},
      {"occurrence", [](const CsvField& f, ValueRow& r) { return set_count(f, r.occurrence); }},
      {"artefact",
       [](const CsvField& f, ValueRow& r) {
         r.artefact = f.text;
         return true;
       }},
      {"program",
       [](const CsvField& f, ValueRow& r) {
         r.program = f.text;
         return true;
       }},
  };
  return all;
}

std::vector<const ReadColumn*> columns_used(const CsvTable& table, const SourceFile& file, Sink& sink) {
  std::vector<std::string_view> names;
  for (const ReadColumn& c : readable_columns()) names.push_back(c.name);
  std::vector<const ReadColumn*> used;
  for (const CsvField& field : table.header) {
    const auto found = std::find(names.begin(), names.end(), field.text);
    used.push_back(found == names.end() ? nullptr
                                        : &readable_columns()[static_cast<std::size_t>(found - names.begin())]);
    if (used.back()) continue;
    sink.add(diagnostic_at(file, field.span, Code::E0526,
                           fmt::format("a recording of values has no column '{}'", field.text),
                           column_help(field.text, names)));
  }
  for (const ReadColumn& c : readable_columns())
    if (c.required && std::find(used.begin(), used.end(), &c) == used.end())
      sink.add(diagnostic_at(file, table.header.front().span, Code::E0527,
                             fmt::format("the column '{}' is missing", c.name),
                             "a recording of values has at least characteristic,value"));
  return used;
}

}  // namespace

ValueRecording read_value_recording(const SourceFile& file) {
  const CsvTable table = read_csv(file);
  Sink sink;
  const std::vector<const ReadColumn*> columns = columns_used(table, file, sink);
  if (sink.has_errors()) throw UserError(sink.list());
  ValueRecording out{file, {}, {}, check_remarks(table, file)};
  for (const CsvRemark& line : table.remarks) out.metadata.emplace_back(line.key, line.value);
  for (const CsvRow& row : table.rows) {
    ValueRow r;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const CsvField& field = row.fields[k];
      if (field.text.empty() && !columns[k]->required) continue;
      if (field.text.empty() || !columns[k]->set(field, r))
        sink.add(diagnostic_at(
            file, field.span, Code::E0530,
            fmt::format("'{}' is no value for the column '{}'", field.text, columns[k]->name),
            "values are in mm or degrees, with a decimal point and no unit; U is not negative; run and occurrence count from 1"));
    }
    out.rows.push_back(std::move(r));
  }
  if (sink.has_errors()) throw UserError(sink.list());
  return out;
}

std::vector<std::string> labels_of(const std::string& characteristic) {
  std::vector<std::string> labels;
  std::string word;
  const auto end = [&](char after) {
    const std::string label = upper(word);
    const bool kind = after == '(' && (label == "FA" || label == "F" || label == "TA" || label == "T");
    if (!label.empty() && !kind) labels.push_back(label);
    word.clear();
  };
  for (const char c : characteristic) {
    if (c == ',' || c == '(' || c == ')' || std::isspace(static_cast<unsigned char>(c)))
      end(c);
    else
      word += c;
  }
  end(' ');
  return labels;
}

}  // namespace abbe
