#include "engine/base/files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "engine/base/diagnostic.hpp"

namespace abbe {

namespace {

[[noreturn]] void fail(const std::string& path, const char* doing) {
  throw UserError(diagnostic(Code::E0602, "cannot write '" + path + "': " + doing + ": " + std::strerror(errno),
                             "check that the folder exists, is writable and has room; the file is unchanged"));
}

}  // namespace

void write_whole(const std::string& path, std::string_view content) {
  std::string temporary = path + ".XXXXXX";
  const int file = mkstemp(temporary.data());
  if (file < 0) fail(path, "creating a temporary file beside it");
  std::size_t done = 0;
  bool good = fchmod(file, 0644) == 0;
  while (good && done < content.size()) {
    const ssize_t n = ::write(file, content.data() + done, content.size() - done);
    if (n < 0 && errno == EINTR) continue;
    good = n >= 0;
    if (good) done += static_cast<std::size_t>(n);
  }
  good = good && fsync(file) == 0;
  const int cause = errno;
  close(file);
  if (!good || std::rename(temporary.c_str(), path.c_str()) != 0) {
    const int rename_cause = good ? errno : cause;
    std::remove(temporary.c_str());
    errno = rename_cause;
    fail(path, "writing");
  }
}

}  // namespace abbe
