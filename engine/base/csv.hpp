// Comma-separated text (RFC 4180) with `#` lines before the header: the form of recordings, tables of values and
// temperature logs. Fields keep their place in the file, so that a message can point at the very number that is wrong.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/base/diagnostic.hpp"

namespace abbe {

/// Reading stops after so many mistakes in one file: more would not help.
inline constexpr std::size_t kMostCsvMessages = 10;

struct CsvField {
  std::string text;  ///< unquoted, blanks around it removed
  Span span;
};

struct CsvRow {
  int line = 0;  ///< of the file, 1-based
  std::vector<CsvField> fields;
};

/// A line `# key: value`.
struct CsvRemark {
  std::string key, value;
  Span span;  ///< of the line
};

struct CsvTable {
  std::vector<CsvRemark> remarks;  ///< other lines that begin with # are free text
  std::vector<CsvField> header;
  std::vector<CsvRow> rows;  ///< blank lines are left out
};

/// Reads the table. Throws UserError: no header, a column twice, quotes that do not enclose a whole field, a row of
/// another length than the header.
CsvTable read_csv(const SourceFile&);

/// A text as a field: in quotes where it needs them.
std::string csv_field(const std::string& text);

/// The next step where a table has a column that is none of the known ones: the nearest, whose unit may be another, or all.
std::string column_help(std::string_view written, const std::vector<std::string_view>& known);

}  // namespace abbe
