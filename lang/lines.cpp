#include "lang/lines.hpp"

#include <algorithm>
#include <cctype>

namespace abbe::lang {

void JoinedText::append(std::string_view piece, std::uint32_t file_offset) {
  append_instead(piece, {file_offset, file_offset + static_cast<std::uint32_t>(piece.size())});
}

void JoinedText::append_instead(std::string_view piece, Span place) {
  pieces_.push_back({text_.size(), place.begin, place.end});
  text_ += piece;
}

std::uint32_t JoinedText::file_offset(std::size_t offset) const {
  if (pieces_.empty()) return 0;
  auto after = std::upper_bound(pieces_.begin(), pieces_.end(), offset,
                                [](std::size_t value, const Piece& piece) { return value < piece.text_begin; });
  if (after != pieces_.begin()) --after;
  const auto inside = static_cast<std::uint32_t>(offset - after->text_begin);
  return std::min(after->file_begin + inside, after->file_end);
}

Span JoinedText::span(std::size_t begin, std::size_t end) const {
  const std::uint32_t first = file_offset(begin);
  return {first, end > begin ? file_offset(end - 1) + 1 : first};
}

namespace {

/// The offset of a single `$` that ends `line` (blanks may follow it), or npos. `$$` is no
/// continuation.
std::size_t continuation_mark(std::string_view line) {
  const std::size_t last = line.find_last_not_of(" \t");
  if (last == std::string_view::npos || line[last] != '$') return std::string_view::npos;
  return last > 0 && line[last - 1] == '$' ? std::string_view::npos : last;
}

/// Of a word, or of a number before its dot; `beside` is what stands on the other side of a dot.
bool in_token(char c, char beside) {
  const auto of_c = static_cast<unsigned char>(c);
  return std::isalnum(of_c) || c == '_' || of_c >= 0x80 ||
      (c == '.' && std::isdigit(static_cast<unsigned char>(beside)));
}

/// Whether a word, a label or a number goes on in the next line behind its indentation. The dots of .EQ. do not.
bool cuts_token(std::string_view before, std::string_view next) {
  const std::size_t indent = next.find_first_not_of(" \t");
  if (before.empty() || indent == std::string_view::npos) return false;
  const auto at = [](std::string_view text, std::size_t k) { return k < text.size() ? text[k] : ' '; };
  const std::size_t last = before.size() - 1;
  return in_token(before[last], at(before, last - 1)) && in_token(next[indent], at(next, indent + 1));
}

/// Joins physical lines one after the other into the logical line that is being built.
class Joiner {
 public:
  /// True when the logical line is complete.
  bool add(std::string_view line, std::uint32_t offset) {
    if (out.comment) return add_comment(line, offset);
    if (!in_string_ && cuts_token(out.code.text(), line)) {
      const std::size_t indent = line.find_first_not_of(" \t");
      line.remove_prefix(indent);
      offset += static_cast<std::uint32_t>(indent);
    }
    const std::size_t comment = find_comment(line);
    if (comment != std::string_view::npos) {
      out.code.append(line.substr(0, comment), offset);
      out.comment.emplace();
      return add_comment(line.substr(comment + 2), offset + static_cast<std::uint32_t>(comment) + 2);
    }
    const std::size_t mark = continuation_mark(line);
    out.code.append(line.substr(0, mark), offset);
    return mark == std::string_view::npos;
  }

  LogicalLine out;

 private:
  bool add_comment(std::string_view line, std::uint32_t offset) {
    const std::size_t mark = continuation_mark(line);
    // In `$$$` the third sign ends nothing: a rule of `$` signs is decoration.
    const bool goes_on = mark != std::string_view::npos && !(mark == 0 && out.comment->text().empty());
    out.comment->append(goes_on ? line.substr(0, mark) : line, offset);
    return !goes_on;
  }

  /// The offset of `$$` outside a string, or npos. Remembers whether a string is open at the end of
  /// the line.
  std::size_t find_comment(std::string_view line) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (line[i] == '\'') in_string_ = !in_string_;
      if (!in_string_ && line.substr(i, 2) == "$$") return i;
    }
    return std::string_view::npos;
  }

  bool in_string_ = false;
};

}  // namespace

std::vector<LogicalLine> logical_lines(const SourceFile& source) {
  std::vector<LogicalLine> lines;
  Joiner joiner;
  bool open = false;
  for (int number = 1; number <= source.line_count(); ++number) {
    std::string_view line = source.line(number);
    std::uint32_t offset = source.line_begin(number);
    if (number == 1 && line.starts_with(kByteOrderMark)) {
      line.remove_prefix(kByteOrderMark.size());
      offset += static_cast<std::uint32_t>(kByteOrderMark.size());
    }
    if (!open) {
      joiner = Joiner{};
      joiner.out.line = number;
    }
    open = !joiner.add(line, offset);
    if (!open) lines.push_back(std::move(joiner.out));
  }
  if (open) lines.push_back(std::move(joiner.out));
  return lines;
}

}  // namespace abbe::lang
