// Physical lines to logical lines (ISO 22093, statement continuation and comments).
//
// A `$` at the end of a line continues it anywhere: inside a word, a number, a quoted string. The
// next line goes on at its first column; the indentation before the rest of a word, label or number that was
// cut does not count, but in a quoted string it does. `$$` outside a string starts a comment, to the end of the
// line; a comment that ends in a single `$` goes on in the next line. A `$` followed by blanks to
// the end of the line counts as the end of the line.
//
// Because a statement may be cut inside a word, the joined text is not a piece of the file. Each
// logical line therefore keeps a piecewise map from joined offset to file offset, and every span
// that leaves this layer is a byte range of the file. Bytes are never recoded: UTF-8 with and
// without byte order mark, Latin-1, LF, CRLF and CR come through as they are.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/source.hpp"

namespace abbe::lang {

/// Text without the `$` marks, with the way back to the file.
class JoinedText {
 public:
  const std::string& text() const { return text_; }
  /// Adds bytes of the file that begin at `file_offset`.
  void append(std::string_view piece, std::uint32_t file_offset);
  /// Adds text that stands in for the bytes `place` of the file: what a macro puts in.
  void append_instead(std::string_view piece, Span place);
  /// Where in the file the byte at `offset` stands; one past the last byte maps to one past its
  /// place.
  std::uint32_t file_offset(std::size_t offset) const;
  /// The bytes of the file from the first to the last byte of [begin, end), the marks between them
  /// included.
  Span span(std::size_t begin, std::size_t end) const;

 private:
  struct Piece {
    std::size_t text_begin;
    std::uint32_t file_begin, file_end;
  };
  std::string text_;
  std::vector<Piece> pieces_;
};

struct LogicalLine {
  JoinedText code;                    ///< the statement, without its comment
  std::optional<JoinedText> comment;  ///< what follows `$$`, without the `$$`
  int line = 1;                       ///< first physical line
};

std::vector<LogicalLine> logical_lines(const SourceFile&);

}  // namespace abbe::lang
