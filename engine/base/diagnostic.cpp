#include "engine/base/diagnostic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "engine/base/utf8.hpp"

namespace abbe {

const std::vector<CodeInfo>& all_codes() {
  static const std::vector<CodeInfo> codes = {
#define X(code, severity, title) {Code::code, #code, Severity::severity, title},
#include "engine/base/diagnostic_codes.def"
#undef X
  };
  return codes;
}

const CodeInfo& info(Code code) { return all_codes()[static_cast<std::size_t>(code)]; }

Diagnostic diagnostic_at(const SourceFile& source, Span span, Code code, std::string message, std::string help,
                         std::string replacement) {
  Diagnostic d = diagnostic(code, std::move(message), std::move(help));
  d.file = source.name();
  d.span = span;
  d.place = source.place(span.begin);
  d.source_line = source.line(d.place.line);
  const int rest_of_line = static_cast<int>(d.source_line.size()) - d.place.column + 1;
  d.caret_length = std::clamp(static_cast<int>(span.end - span.begin), 1, std::max(1, rest_of_line));
  d.replacement = std::move(replacement);
  return d;
}

Diagnostic diagnostic(Code code, std::string message, std::string help) {
  Diagnostic d;
  d.code = code;
  d.message = std::move(message);
  d.help = std::move(help);
  return d;
}

std::string_view name(Severity severity) {
  return severity == Severity::error ? "error" : severity == Severity::warning ? "warning" : "note";
}

namespace {

/// A blank for each character before a byte of the line, with tabs kept so that the caret stands under the text.
std::string indent_like(std::string_view line, std::size_t bytes) {
  std::string out;
  for (std::size_t at = 0; at < std::min(bytes, line.size()); at += character_at(line, at).bytes)
    out += line[at] == '\t' ? '\t' : ' ';
  return out;
}

/// Columns count bytes; carets stand under characters.
std::string carets(const Diagnostic& d) {
  const std::string_view line = d.source_line;
  const std::size_t begin = std::min(static_cast<std::size_t>(d.place.column - 1), line.size());
  const std::size_t under = count_characters(line.substr(begin, static_cast<std::size_t>(d.caret_length)));
  return indent_like(line, begin) + std::string(std::max<std::size_t>(under, 1), '^');
}

}  // namespace

std::string render(const Diagnostic& d) {
  std::string out;
  if (!d.file.empty()) out += d.span ? fmt::format("{}:{}:{}: ", d.file, d.place.line, d.place.column) : d.file + ": ";
  out += fmt::format("{} {}: {}\n", name(d.severity()), info(d.code).name, d.message);
  if (d.span) {
    out += fmt::format("  {}\n  {}\n", d.source_line, carets(d));
  }
  if (!d.help.empty()) out += "  help: " + d.help + "\n";
  return out;
}

std::vector<Diagnostic> Sink::sorted() const {
  std::vector<Diagnostic> out = list_;
  std::stable_sort(out.begin(), out.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return (a.span ? a.span->begin : 0) < (b.span ? b.span->begin : 0);
  });
  return out;
}

bool Sink::has_errors() const {
  return std::any_of(list_.begin(), list_.end(), [](const Diagnostic& d) { return d.severity() == Severity::error; });
}

UserError::UserError(Diagnostic d) : UserError(std::vector<Diagnostic>{std::move(d)}) {}

UserError::UserError(std::vector<Diagnostic> list)
    : std::runtime_error(list.empty() ? "unusable input" : list.front().message), list_(std::move(list)) {}

namespace {

/// How many slips of the pen lead from one word to the other: a letter too many, too few, another one, or two
/// neighbours exchanged ("optimal string alignment" distance).
int edit_distance(std::string_view a, std::string_view b) {
  const auto same = [&](std::size_t i, std::size_t j) {
    return std::toupper(static_cast<unsigned char>(a[i])) == std::toupper(static_cast<unsigned char>(b[j]));
  };
  std::vector<int> before, last, row(b.size() + 1);  // for the first i-2, i-1 and i letters of a
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before = std::move(last);
    last = row;
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same(i - 1, j - 1) ? 0 : 1)});
      if (i > 1 && j > 1 && same(i - 1, j - 2) && same(i - 2, j - 1)) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

/// The letters of one word in another order: "XZPLAN" is ZXPLAN rather than XYPLAN.
bool same_letters(std::string_view a, std::string_view b) {
  return std::is_permutation(a.begin(), a.end(), b.begin(), b.end(),
                             [](unsigned char x, unsigned char y) { return std::toupper(x) == std::toupper(y); });
}

}  // namespace

std::string nearest_word(std::string_view word, const std::vector<std::string_view>& candidates) {
  constexpr int kTooFar = 3;
  constexpr std::size_t kLongest = 256;  // nobody slips in a longer word, and the time goes with the square
  std::string_view best;
  std::pair least{kTooFar, false};
  for (const std::string_view candidate : candidates) {
    const std::size_t longer = std::max(word.size(), candidate.size()),
                      shorter = std::min(word.size(), candidate.size());
    if (longer > kLongest || longer - shorter >= static_cast<std::size_t>(kTooFar)) continue;
    const std::pair distance{edit_distance(word, candidate), !same_letters(word, candidate)};
    if (distance < least && 3 * distance.first <= static_cast<int>(longer)) best = candidate, least = distance;
  }
  return std::string(best);
}

}  // namespace abbe
