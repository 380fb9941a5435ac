#include "engine/report/html_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "engine/report/plot.hpp"

namespace abbe {

namespace {

constexpr std::string_view kStyle =
    "body{font:15px/1.45 sans-serif;max-width:820px;margin:2em auto;padding:0 1em;color:#222;background:#fff;overflow-wrap:break-word}"
    "h1{font-size:1.5em}h2{font-size:1.15em;margin-top:1.8em;border-bottom:1px solid #ccc}"
    ".wide{overflow-x:auto}table{border-collapse:collapse;margin:.6em 0;font-size:.92em}"
    "td,th{padding:.25em .7em .25em 0;text-align:left;border-bottom:1px solid #8885;vertical-align:top}"
    "td.n{font-variant-numeric:tabular-nums;white-space:nowrap}pre{overflow:auto;background:#f5f5f5;padding:.8em;font-size:.85em}"
    "svg{max-width:100%;height:auto}.pair{display:flex;flex-wrap:wrap}.note{color:#555;font-size:.9em}"
    "@media(prefers-color-scheme:dark){body{color:#ddd;background:#181818}pre{background:#222}.note{color:#aaa}}"
    "@media(max-width:500px){body{margin:1em auto;font-size:14px}table{font-size:.85em}}"
    "@media print{body{max-width:none;margin:0;color:#000;background:#fff;font-size:10pt}h2{break-after:avoid}tr,svg{break-inside:avoid}"
    ".pair svg{width:49%}.note{color:#333}details{display:none}}";

}  // namespace

std::string html_page(std::string_view title, std::string_view body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\n"
      "<title>{}</title><style>{}</style></head><body>\n{}</body></html>\n",
      escaped(title), kStyle, body);
}

std::string html_row(const std::vector<std::string>& cells, const char* tag) {
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  std::string out = "<tr>";
  for (const std::string& c : cells) {
    const bool number = !c.empty() &&
        (is_digit(c[0]) || ((c[0] == '-' || c[0] == '+' || c[0] == '<') && c.size() > 1 && is_digit(c[1])));
    out += fmt::format("<{}{}>{}</{}>", tag, number ? " class=\"n\"" : "", escaped(c), tag);
  }
  return out + "</tr>\n";
}

std::string html_table(std::string_view rows) {
  return fmt::format("<div class=\"wide\"><table>{}</table></div>\n", rows);
}

std::string html_paragraphs(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (end > 0) out += fmt::format("<p>{}</p>\n", escaped(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

}  // namespace abbe
