#include "programs/lsp/transport.hpp"

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
    if (line.size() > kLongestHeader) break;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> read_message(std::FILE* in) {
  constexpr std::string_view kLength = "Content-Length:";
  std::optional<std::size_t> length;
  for (auto line = header_line(in); !line || !line->empty(); line = header_line(in)) {
    if (!line) return std::nullopt;
    if (!line->starts_with(kLength)) continue;
    const std::size_t begin = line->find_first_not_of(' ', kLength.size());
    std::size_t value = 0;
    const char* const end = line->data() + line->size();
    if (begin == std::string::npos || std::from_chars(line->data() + begin, end, value).ptr != end ||
        value > kLongestMessage)
      return std::nullopt;
    length = value;
  }
  if (!length) return std::nullopt;
  std::string message(*length, '\0');
  if (std::fread(message.data(), 1, *length, in) != *length) return std::nullopt;
  return message;
}

void write_message(std::FILE* out, std::string_view text) {
  std::fprintf(out, "Content-Length: %zu\r\n\r\n", text.size());
  std::fwrite(text.data(), 1, text.size(), out);
  std::fflush(out);
}

}  // namespace abbe::lsp
