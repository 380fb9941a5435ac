// A report as one HTML file: style, tables and plots inside, no script and no network, so that it can be
// filed, sent and printed.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace abbe {

/// The whole page. `title` is text, `body` HTML.
std::string html_page(std::string_view title, std::string_view body);

/// A row of a table, its cells text; "td", or "th" for the titles. What begins with a digit counts as a number.
std::string html_row(const std::vector<std::string>& cells, const char* tag = "td");

/// A table of such rows that scrolls by itself where the page is too narrow for it.
std::string html_table(std::string_view rows);

/// Paragraphs, one for each line of a text.
std::string html_paragraphs(std::string_view text);

}  // namespace abbe
