#include "lang/format.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "lang/blocks.hpp"
#include "lang/lines.hpp"
#include "lang/parser.hpp"
#include "lang/vocabulary.hpp"

namespace abbe::lang {

namespace {

constexpr std::size_t kIndent = 2, kContinuationIndent = 4;
/// A program that forgets its ENDMES hundreds of times must not grow with the square of its length.
constexpr int kDeepest = 12;

std::string in_quotes(std::string_view text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

std::string written(const RawArgument& argument) {
  switch (argument.kind) {
    case RawArgument::Kind::text: return in_quotes(argument.text);
    case RawArgument::Kind::label: return written(argument.label);
    case RawArgument::Kind::word: {
      const std::string word = upper(argument.text);
      const std::string_view plain = word.starts_with('+') ? std::string_view(word).substr(1) : std::string_view(word);
      return minor_words().contains(plain) ? word : argument.text;  // else perhaps a variable
    }
    default: return argument.text;
  }
}

/// The statement in the fewest pieces that may stand in lines of their own: each ends behind a
/// comma, but for the last.
std::vector<std::string> pieces(const RawStatement& raw) {
  if (raw.target) return {fmt::format("({})", raw.target->name)};
  std::vector<std::string> out = {raw.label ? written(*raw.label) + "=" : ""};
  out.back() += raw.word;
  for (std::size_t i = 0; i < raw.arguments.size(); ++i) {
    const std::string text =
        (i == 0 ? "/" : "") + written(raw.arguments[i]) + (i + 1 < raw.arguments.size() ? "," : "");
    if (i == 0)
      out.back() += text;
    else
      out.push_back(text);
  }
  return out;
}

std::string_view without_blanks_at_end(std::string_view line) {
  const std::size_t last = line.find_last_not_of(" \t");
  return line.substr(0, last == std::string_view::npos ? 0 : last + 1);
}

/// The file's own; LF for a file without one.
std::string_view first_line_end(std::string_view text) {
  const std::size_t at = text.find_first_of("\r\n");
  if (at == std::string_view::npos) return "\n";
  return text.substr(at, text.substr(at, 2) == "\r\n" ? 2 : 1);
}

class Formatter {
 public:
  explicit Formatter(const SourceFile& source) : source_(source), line_end_(first_line_end(source.text())) {}

  std::string run() {
    const std::vector<LogicalLine> lines = logical_lines(source_);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      last_line_ = i + 1 < lines.size() ? lines[i + 1].line - 1 : source_.line_count();
      one(lines[i]);
    }
    while (!out_.empty() && out_.back().empty()) out_.pop_back();
    std::string text = source_.text().starts_with(kByteOrderMark) ? std::string(kByteOrderMark) : "";
    for (const std::string& line : out_) text.append(line).append(line_end_);
    return text;
  }

 private:
  void one(const LogicalLine& line) {
    Sink ignored;
    const std::optional<RawStatement> raw = parse_statement(line, source_, ignored);
    const Nesting nesting = raw ? nesting_of(*raw) : Nesting{};
    depth_ = std::max(0, depth_ + nesting.before);
    const bool blank = line.code.text().find_first_not_of(" \t") == std::string::npos;
    if (blank)
      comment(line, std::string(indent(), ' '));
    else if (raw && (raw->target || raw->usable))
      statement(line, *raw);
    else
      unchanged(line);
    depth_ += nesting.after;
  }

  std::size_t indent() const { return kIndent * static_cast<std::size_t>(std::min(depth_, kDeepest)); }

  void statement(const LogicalLine& line, const RawStatement& raw) {
    std::string current(indent(), ' ');
    bool fresh = true;
    const std::vector<std::string> parts = pieces(raw);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const std::size_t mark = i + 1 < parts.size() ? 1 : 0;  // room for the `$`
      const bool fits = current.size() + parts[i].size() + mark <= kFormattedColumns;
      if (!fresh && !fits && !parts[i].empty()) {  // behind a last comma there is nothing: a blank line would end it
        out_.push_back(current + "$");
        current.assign(indent() + kContinuationIndent, ' ');
      }
      current += parts[i];
      fresh = false;
    }
    if (line.comment)
      comment(line, current + " ");
    else
      out_.push_back(current);
  }

  /// `before`, then the comment of the line as it was written, over all of its physical lines.
  void comment(const LogicalLine& line, const std::string& before) {
    if (!line.comment) return out_.push_back("");
    const std::uint32_t begin = line.comment->file_offset(0) - 2;  // its `$$`
    const int first = source_.place(begin).line;
    for (int number = first; number <= last_line_; ++number) {
      const std::string_view text = source_.line(number);
      const std::string_view kept = number == first ? text.substr(begin - source_.line_begin(number)) : text;
      out_.push_back((number == first ? before : "") + std::string(without_blanks_at_end(kept)));
    }
  }

  void unchanged(const LogicalLine& line) {
    for (int number = line.line; number <= last_line_; ++number) {
      std::string_view text = source_.line(number);
      if (number == 1 && text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
      out_.emplace_back(text);
    }
  }

  const SourceFile& source_;
  std::string_view line_end_;
  std::vector<std::string> out_;
  int depth_ = 0, last_line_ = 0;
};

}  // namespace

std::string format(const SourceFile& source) { return Formatter(source).run(); }

}  // namespace abbe::lang
