#include "engine/base/source.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "engine/base/diagnostic.hpp"
#include "engine/base/utf8.hpp"

namespace abbe {

SourceFile::SourceFile(std::string name, std::string text) : name_(std::move(name)), text_(std::move(text)) {
  line_begin_.push_back(0);
  for (std::size_t i = 0; i < text_.size(); ++i) {
    const bool cr_of_crlf = text_[i] == '\r' && i + 1 < text_.size() && text_[i + 1] == '\n';
    if ((text_[i] == '\n' || text_[i] == '\r') && !cr_of_crlf) line_begin_.push_back(static_cast<std::uint32_t>(i + 1));
  }
}

std::string_view SourceFile::text(Span span) const {
  return std::string_view(text_).substr(span.begin, span.end - span.begin);
}

Place SourceFile::place(std::uint32_t offset) const {
  const auto after = std::upper_bound(line_begin_.begin(), line_begin_.end(), offset);
  const auto line = static_cast<int>(after - line_begin_.begin());
  return {line, static_cast<int>(offset - line_begin_[line - 1]) + 1};
}

std::string_view SourceFile::line(int one_based) const {
  const std::size_t begin = line_begin_[one_based - 1];
  std::size_t end = one_based < line_count() ? line_begin_[one_based] : text_.size();
  while (end > begin && (text_[end - 1] == '\n' || text_[end - 1] == '\r')) --end;
  return std::string_view(text_).substr(begin, end - begin);
}

SourceFile read_source(const std::string& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  // Opening a directory succeeds on Linux; reading it then fails, which is caught here too.
  if (!file || (file.peek() != std::ifstream::traits_type::eof() && !(text << file.rdbuf())) || file.bad()) {
    const char* cause = errno != 0 ? std::strerror(errno) : "it cannot be read";
    throw UserError(
        diagnostic(Code::E0601, "cannot read '" + path + "': " + cause, "check the name and the permissions"));
  }
  std::string bytes = text.str();
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF"))
    throw UserError(
        diagnostic(Code::E0618, "'" + path + "' is in UTF-16", "save it as UTF-8 (\"CSV UTF-8\" in Excel)"));
  return SourceFile(path, std::move(bytes));
}

namespace {

/// Windows-1252 above 0x7F; it is Latin-1 but for these. Bytes without a character stay the control
/// characters that they are in Latin-1.
char32_t windows_1252(unsigned char byte) {
  constexpr char32_t kPunctuation[32] = {0x20AC, 0x81,   0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021,
                                         0x02C6, 0x2030, 0x0160, 0x2039, 0x0152, 0x8D,   0x017D, 0x8F,
                                         0x90,   0x2018, 0x2019, 0x201C, 0x201D, 0x2022, 0x2013, 0x2014,
                                         0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0x9D,   0x017E, 0x0178};
  return byte >= 0x80 && byte < 0xA0 ? kPunctuation[byte - 0x80] : byte;
}

std::string from_windows_1252(std::string_view text) {
  std::string out;
  for (const char c : text) append_utf8(out, windows_1252(static_cast<unsigned char>(c)));
  return out;
}

}  // namespace

SourceFile read_text(const std::string& path, Sink& sink) {
  SourceFile file = read_source(path);
  const std::size_t foreign = first_foreign(file.text());
  if (foreign == file.text().size()) return file;
  const int line = file.place(static_cast<std::uint32_t>(foreign)).line;
  sink.add(diagnostic(Code::N0617,
                      path + ":" + std::to_string(line) + ": this text is not UTF-8; it is read as Windows-1252",
                      "save it as UTF-8 if letters look wrong"));
  return SourceFile(path, from_windows_1252(file.text()));
}

}  // namespace abbe
