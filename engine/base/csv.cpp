#include "engine/base/csv.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "engine/base/numbers.hpp"

namespace abbe {

namespace {

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

/// The fields of one line. A quoted field ends on its line: labels of features hold no line ends.
std::vector<CsvField> split(const SourceFile& file, std::string_view line, std::uint32_t begin, Sink& sink) {
  std::vector<CsvField> fields;
  std::size_t at = 0;
  while (true) {
    std::size_t from = at;
    while (from < line.size() && (line[from] == ' ' || line[from] == '\t')) ++from;
    std::string text;
    if (from < line.size() && line[from] == '"') {
      std::size_t i = from + 1;
      for (; i < line.size(); ++i) {
        if (line[i] != '"')
          text += line[i];
        else if (i + 1 < line.size() && line[i + 1] == '"')
          text += line[i++];
        else
          break;
      }
      at = std::min(line.find(',', i), line.size());
      const bool closed = i < line.size();
      const std::size_t wrong = closed ? i + 1 : from;
      if (!closed || !trimmed(line.substr(wrong, at - wrong)).empty())
        sink.add(diagnostic_at(
            file, {begin + static_cast<std::uint32_t>(wrong), begin + static_cast<std::uint32_t>(at)}, Code::E0521,
            closed ? "this stands behind the quote that closes the field" : "this quote is not closed on its line",
            "write \"\" for a quote inside a quoted field"));
    } else {
      at = std::min(line.find(',', from), line.size());
      text = trimmed(line.substr(from, at - from));
    }
    const auto first = begin + static_cast<std::uint32_t>(from);
    fields.push_back({std::move(text), {first, std::max(first + 1, begin + static_cast<std::uint32_t>(at))}});
    if (at >= line.size()) return fields;
    ++at;
  }
}

void read_remark(std::string_view line, std::uint32_t begin, CsvTable& table) {
  while (!line.empty() && (line.back() == ',' || line.back() == ' ')) line.remove_suffix(1);  // of a spreadsheet
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) return;
  table.remarks.push_back({std::string(trimmed(line.substr(1, colon - 1))),
                           std::string(trimmed(line.substr(colon + 1))),
                           {begin, begin + static_cast<std::uint32_t>(line.size())}});
}

/// Where Excel writes decimal commas it writes semicolons between the columns.
void check_separator(const SourceFile& file, const std::vector<CsvField>& header) {
  if (header.size() > 1) return;
  for (const auto& [separator, word] : {std::pair{';', "semicolons"}, std::pair{'\t', "tabs"}})
    if (header.front().text.find(separator) != std::string::npos)
      throw UserError(diagnostic_at(
          file, header.front().span, Code::E0531, fmt::format("the columns are divided by {}", word),
          "write commas between the columns and decimal points in the numbers (\"CSV UTF-8\" with English number formats)"));
}

void check_header(const SourceFile& file, const std::vector<CsvField>& header, Sink& sink) {
  for (const CsvField& field : header)
    if (finite_number(field.text))
      throw UserError(diagnostic_at(
          file, field.span, Code::E0524, fmt::format("'{}' names no column: the header is missing", field.text),
          "the first line names the columns, every other line is one row (docs/recording.md)"));
  std::set<std::string> seen;
  for (const CsvField& field : header)
    if (!seen.insert(field.text).second)
      sink.add(diagnostic_at(file, field.span, Code::E0522,
                             fmt::format("column '{}' stands here for the second time", field.text),
                             "remove one of the two"));
}

}  // namespace

CsvTable read_csv(const SourceFile& file) {
  CsvTable table;
  Sink sink;
  for (int number = 1; number <= file.line_count() && sink.list().size() < kMostCsvMessages; ++number) {
    std::string_view line = file.line(number);
    std::uint32_t begin = file.line_begin(number);
    if (number == 1 && line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size()), begin += 3;
    while (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (trimmed(line).empty()) continue;
    if (line.front() == '#') {
      read_remark(line, begin, table);
      continue;
    }
    std::vector<CsvField> fields = split(file, line, begin, sink);
    // A spreadsheet fills lines up with commas, and quotes a line of comment that has some of its own.
    const bool one_field =
        std::all_of(fields.begin() + 1, fields.end(), [](const CsvField& f) { return f.text.empty(); });
    if (one_field && fields.size() > 1 && fields.front().text.empty()) continue;
    if (one_field && table.header.empty() && fields.front().text.starts_with('#')) {
      read_remark(fields.front().text, begin, table);
      continue;
    }
    if (table.header.empty()) {
      check_separator(file, fields);
      table.header = std::move(fields);
      check_header(file, table.header, sink);
    } else if (fields.size() != table.header.size()) {
      sink.add(diagnostic_at(file, fields.front().span, Code::E0523,
                             fmt::format("this line has {} value{}, the header {} columns", fields.size(),
                                         fields.size() == 1 ? "" : "s", table.header.size()),
                             "every line holds one value, or nothing, for each column"));
    } else {
      table.rows.push_back({number, std::move(fields)});
    }
  }
  if (sink.has_errors()) throw UserError(sink.list());
  if (table.header.empty() || table.rows.empty())
    throw UserError(diagnostic_at(file, {0, 1}, Code::E0524, "the file has no rows",
                                  "the first line names the columns, every other line is one row (docs/recording.md)"));
  return table;
}

std::string csv_field(const std::string& text) {
  const bool like_a_comment = text.starts_with('#');
  if (text.find_first_of(",\"\r\n") == std::string::npos && !like_a_comment) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

std::string column_help(std::string_view written, const std::vector<std::string_view>& known) {
  if (written.empty())
    return "two commas stand together, or one at the end of the line: leave it out, there and in the rows";
  const std::string near = nearest_word(written, known);
  const std::string_view stem = written.substr(0, written.find_first_of("_ ([/"));
  if (near.empty() && std::find(known.begin(), known.end(), stem) != known.end())
    return fmt::format("did you mean '{}'? Its name has no unit (docs/recording.md tells which it is in)", stem);
  if (near.empty()) return fmt::format("its columns are: {}", fmt::join(known, ", "));
  if (near == "U") return "'U' is an expanded uncertainty (k = 2): twice the standard one";
  return fmt::format("did you mean '{}'?{}", near,
                     differ_in_unit(written, near) ? " That is another unit: convert the numbers" : "");
}

}  // namespace abbe
