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

constexpr std::size_t kLineWidth = 160;        ///< characters of a source line that are shown
constexpr std::size_t kBeforeCaret = 60;       ///< of them before the caret, in a longer line
constexpr std::size_t kLongestMessage = 2000;  ///< bytes; names of a program may be of any length
constexpr std::string_view kLeftOut = "...";

/// Control characters, which a terminal may obey, as the signs that Unicode has for them.
void append_visible(std::string& out, std::string_view text, std::size_t at) {
  const Character c = character_at(text, at);
  if (c.code < 0x20)
    append_utf8(out, 0x2400 + c.code);
  else if (c.code == 0x7F)
    append_utf8(out, 0x2421);
  else if (c.code >= 0x80 && c.code < 0xA0)
    append_utf8(out, 0xFFFD);
  else
    out += text.substr(at, c.bytes);
}

/// What is said of a text: line ends and tabs are ours.
std::string visible(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size(); at += character_at(text, at).bytes) {
    if (out.size() > kLongestMessage) return out + std::string(kLeftOut);
    if (text[at] == '\n' || text[at] == '\t')
      out += text[at];
    else
      append_visible(out, text, at);
  }
  return out;
}

/// The source line and the carets under it, of a long line what lies about the place. Columns count bytes; carets stand
/// under characters, and tabs are kept for that.
std::string marked_line(const Diagnostic& d) {
  const std::string_view line = d.source_line;
  const std::size_t begin = std::min(static_cast<std::size_t>(d.place.column - 1), line.size());
  const std::size_t caret = count_characters(line.substr(0, begin));
  const std::size_t size = count_characters(line);
  const std::size_t first = size <= kLineWidth ? 0 : std::min(caret - std::min(caret, kBeforeCaret), size - kLineWidth);
  const std::size_t shown = std::min(size - first, kLineWidth), last = first + shown;
  const std::size_t under = count_characters(line.substr(begin, static_cast<std::size_t>(std::max(d.caret_length, 0))));

  std::string text, marks;
  if (first > 0) text = kLeftOut, marks = std::string(kLeftOut.size(), ' ');
  std::size_t at = first_characters(line, first).size();
  for (std::size_t k = first; k < last; ++k, at += character_at(line, at).bytes) {
    if (line[at] == '\t')
      text += '\t';
    else
      append_visible(text, line, at);
    if (k < caret) marks += line[at] == '\t' ? '\t' : ' ';
  }
  if (last < size) text += kLeftOut;
  const std::size_t room = last > caret ? last - caret : 1;
  return fmt::format("  {}\n  {}\n", text, marks + std::string(std::clamp<std::size_t>(under, 1, room), '^'));
}

}  // namespace

std::string render(const Diagnostic& d) {
  std::string out;
  if (!d.file.empty()) out += d.span ? fmt::format("{}:{}:{}: ", d.file, d.place.line, d.place.column) : d.file + ": ";
  out += fmt::format("{} {}: {}\n", name(d.severity()), info(d.code).name, visible(d.message));
  if (d.span) out += marked_line(d);
  if (!d.help.empty()) out += "  help: " + visible(d.help) + "\n";
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

std::string nearest_name(std::string_view word, const std::vector<std::string_view>& candidates) {
  constexpr std::size_t kShortest = 3;
  if (std::string near = nearest_word(word, candidates); !near.empty()) return near;
  if (word.size() < kShortest) return "";
  const auto tail = [](std::string_view name) { return name.substr(name.rfind('.') + 1); };
  std::vector<std::string_view> tails;
  for (const std::string_view name : candidates) tails.push_back(tail(name));
  const std::string near_tail = nearest_word(tail(word), tails);
  const auto is_part = [&](std::string_view name) {
    const auto divides = [](char c) { return c == '.' || c == '_'; };
    return !near_tail.empty()        ? tail(name) == near_tail
        : name.size() <= word.size() ? false
                                     : (name.starts_with(word) && divides(name[word.size()])) ||
            (name.ends_with(word) && divides(name[name.size() - word.size() - 1]));
  };
  const auto first = std::find_if(candidates.begin(), candidates.end(), is_part);
  const bool only = first != candidates.end() && std::none_of(first + 1, candidates.end(), is_part);
  return only ? std::string(*first) : "";
}

bool differ_in_unit(std::string_view name, std::string_view other) {
  constexpr std::string_view kUnits[] = {"C", "F", "K", "m", "mm", "um", "nm", "in", "inch", "deg", "rad", "arcsec"};
  if ((name == "U" && other == "u") || (name == "u" && other == "U")) return true;
  const auto parts = [](std::string_view text) {
    const std::size_t at = std::min(text.rfind('_'), text.size());
    return std::pair{text.substr(0, at), text.substr(std::min(at + 1, text.size()))};
  };
  const auto is_unit = [&](std::string_view word) {
    return std::find(std::begin(kUnits), std::end(kUnits), word) != std::end(kUnits);
  };
  const auto [stem, unit] = parts(name);
  const auto [other_stem, other_unit] = parts(other);
  return stem == other_stem && unit != other_unit && is_unit(unit) && is_unit(other_unit);
}

}  // namespace abbe
