#include "programs/lsp/positions.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace abbe::lsp {

namespace {

/// The code point that begins at `at`: its bytes and its UTF-16 units.
struct CodePoint {
  std::size_t bytes = 1, units = 1;
};

CodePoint code_point(std::string_view text, std::size_t at) {
  const auto byte = static_cast<unsigned char>(text[at]);
  const std::size_t bytes = byte >= 0xF0 ? 4 : byte >= 0xE0 ? 3 : byte >= 0xC0 ? 2 : 1;
  if (at + bytes > text.size()) return {};
  for (std::size_t k = 1; k < bytes; ++k)
    if ((static_cast<unsigned char>(text[at + k]) & 0xC0) != 0x80) return {};
  return {bytes, bytes == 4 ? std::size_t{2} : std::size_t{1}};
}

}  // namespace

nlohmann::json position(const SourceFile& source, std::uint32_t offset) {
  const Place place = source.place(offset);
  const std::string_view line = source.line(place.line);
  const std::size_t end = std::min(static_cast<std::size_t>(place.column - 1), line.size());
  std::size_t units = 0;
  for (std::size_t at = 0; at < end;) {
    const CodePoint point = code_point(line, at);
    at += point.bytes;
    units += point.units;
  }
  return {{"line", place.line - 1}, {"character", units}};
}

nlohmann::json range(const SourceFile& source, Span span) {
  return {{"start", position(source, span.begin)}, {"end", position(source, span.end)}};
}

std::uint32_t offset_of(const SourceFile& source, std::uint64_t line_index, std::uint64_t character) {
  if (line_index >= static_cast<std::uint64_t>(source.line_count()))
    return static_cast<std::uint32_t>(source.text().size());
  const int number_of_line = static_cast<int>(line_index) + 1;
  const std::string_view line = source.line(number_of_line);
  auto left = static_cast<std::int64_t>(std::min<std::uint64_t>(character, line.size()));
  std::size_t at = 0;
  while (left > 0 && at < line.size()) {
    const CodePoint point = code_point(line, at);
    at += point.bytes;
    left -= static_cast<std::int64_t>(point.units);
  }
  return source.line_begin(number_of_line) + static_cast<std::uint32_t>(at);
}

}  // namespace abbe::lsp
