#include "programs/lsp/transport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace abbe::lsp {

namespace {

constexpr std::size_t kLongestHeader = 1024;

/// A header line without its CR LF; nothing at the end of the input.
std::optional<std::string> header_line(std::FILE* in) {
  std::string line;
  for (int c = std::fgetc(in); c != EOF; c = std::fgetc(in)) {
    if (c == '\n') {
      if (line.ends_with('\r')) line.pop_back();
      return line;
    }
    line += static_cast<char>(c);
    if (line.size() > kLongestHeader)
      throw BrokenFrame{fmt::format("a header line is longer than {} bytes", kLongestHeader)};
  }
  if (!line.empty()) throw BrokenFrame{fmt::format("the input ends in the header line '{}'", line)};
  return std::nullopt;
}

std::size_t length_in(std::string_view header, std::size_t behind_name) {
  const std::size_t begin = std::min(header.find_first_not_of(' ', behind_name), header.size());
  std::size_t value = 0;
  const char* const end = header.data() + header.size();
  const auto [stop, failure] = std::from_chars(header.data() + begin, end, value);
  if (begin == header.size() || stop != end || failure != std::errc{} || value > kLongestMessage)
    throw BrokenFrame{fmt::format("'{}' names no length up to {} bytes", header, kLongestMessage)};
  return value;
}

}  // namespace

std::optional<std::string> read_message(std::FILE* in) {
  constexpr std::string_view kLength = "Content-Length:";
  std::optional<std::size_t> length;
  auto line = header_line(in);
  if (!line) return std::nullopt;
  for (; line && !line->empty(); line = header_line(in))
    if (line->starts_with(kLength)) length = length_in(*line, kLength.size());
  if (!line) throw BrokenFrame{"the input ends in the header of a message"};
  if (!length) throw BrokenFrame{"the header of a message has no Content-Length"};
  std::string message(*length, '\0');
  if (std::fread(message.data(), 1, *length, in) != *length)
    throw BrokenFrame{fmt::format("the input ends inside a message of {} bytes", *length)};
  return message;
}

void write_message(std::FILE* out, std::string_view text) {
  std::fprintf(out, "Content-Length: %zu\r\n\r\n", text.size());
  std::fwrite(text.data(), 1, text.size(), out);
  std::fflush(out);
}

}  // namespace abbe::lsp
