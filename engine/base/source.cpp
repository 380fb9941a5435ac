#include "engine/base/source.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "engine/base/diagnostic.hpp"

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
    throw UserError(diagnostic(Code::E0601, "cannot read '" + path + "': " + cause, "check the name and the permissions"));
  }
  return SourceFile(path, text.str());
}

}  // namespace abbe
