// A table of text cells with aligned columns, for reports on a terminal.
#pragma once

#include <string>
#include <vector>

namespace abbe {

class Table {
 public:
  enum class Align { left, right };
  struct Column {
    std::string title;
    Align align = Align::right;
  };

  explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}
  /// One cell per column.
  void add(std::vector<std::string> cells);
  /// Title line and rows, two blanks between columns, no blanks at line ends.
  std::string to_text() const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// How many characters a terminal shows for `text`: UTF-8 continuation bytes take no place.
int display_width(const std::string& text);

}  // namespace abbe
