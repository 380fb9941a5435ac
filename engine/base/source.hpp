// A text that the user wrote (a part program, a JSON file, a CSV) and places in it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace abbe {

/// UTF-8 files of some editors begin with these bytes; they are no part of the text.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// A half-open range of bytes [begin, end) of a SourceFile.
struct Span {
  std::uint32_t begin = 0, end = 0;
  constexpr bool operator==(const Span&) const = default;
};

/// 1-based line and column. Columns count bytes of the line, as g++ and clang print them.
struct Place {
  int line = 1, column = 1;
  constexpr bool operator==(const Place&) const = default;
};

/// The bytes of one file as they were read, and its line table. LF, CRLF and CR end lines.
class SourceFile {
 public:
  SourceFile(std::string name, std::string text);

  const std::string& name() const { return name_; }
  std::string_view text() const { return text_; }
  std::string_view text(Span span) const;
  Place place(std::uint32_t offset) const;
  int line_count() const { return static_cast<int>(line_begin_.size()); }
  /// The bytes of a line without its line end.
  std::string_view line(int one_based) const;
  /// The offset of the first byte of a line.
  std::uint32_t line_begin(int one_based) const { return line_begin_[one_based - 1]; }

 private:
  std::string name_, text_;
  std::vector<std::uint32_t> line_begin_;
};

/// Reads a whole file. Throws UserError (diagnostic.hpp) where it cannot, and of UTF-16: nothing reads that.
SourceFile read_source(const std::string& path);

class Sink;

/// Reads a file of text that people or other programs wrote. What is not UTF-8 is taken as Windows-1252, of
/// which Latin-1 is a part, and the sink says so (N0617). Throws UserError as read_source does.
SourceFile read_text(const std::string& path, Sink&);

}  // namespace abbe
