#include "engine/base/files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <utility>

#include "engine/base/diagnostic.hpp"

namespace abbe {

namespace {

[[noreturn]] void fail(const std::string& path, const char* doing) {
  throw UserError(diagnostic(
      Code::E0602, "cannot write '" + path + "': " + doing + ": " + std::strerror(errno),
      "check that the folder exists and has room, and that it and the file are writable; nothing was changed"));
}

/// Closes what it holds.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { ::close(number_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

 private:
  int number_;
};

/// Whoever ends the program while a file is written gets it whole, and no temporary file stays behind: the
/// signal waits. That of a closed pipe too: the write fails, the temporary files go, and then it ends the program.
class SignalsWait {
 public:
  SignalsWait() {
    sigset_t ending;
    sigemptyset(&ending);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) sigaddset(&ending, signal);
    pthread_sigmask(SIG_BLOCK, &ending, &before_);
  }
  ~SignalsWait() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;

 private:
  sigset_t before_;
};

bool write_all(int file, std::string_view content) {
  for (std::size_t done = 0; done < content.size();) {
    const ssize_t n = ::write(file, content.data() + done, content.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

/// A terminal, a pipe, /dev/null: what is there takes the content, a file in its place would only hide it.
bool takes_content(const std::string& path) {
  struct stat there {};
  return ::stat(path.c_str(), &there) == 0 &&
      (S_ISCHR(there.st_mode) || S_ISBLK(there.st_mode) || S_ISFIFO(there.st_mode) || S_ISSOCK(there.st_mode));
}

void write_into(const std::string& path, std::string_view content) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) fail(path, "opening it");
  const Descriptor closes(file);
  if (!write_all(file, content)) fail(path, "writing");
}

/// Of a file that nobody may write the content stays, whoever asks: root too.
void refuse_read_only(const std::string& path) {
  constexpr mode_t kAnyoneWrites = S_IWUSR | S_IWGRP | S_IWOTH;
  struct stat there {};
  if (::stat(path.c_str(), &there) != 0) return;
  errno = EACCES;
  if ((there.st_mode & kAnyoneWrites) == 0 || ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0)
    fail(path, "replacing it");
}

/// Names of no file: what an unset variable of the shell leaves, what other programs take for standard output, and folders.
void refuse_no_file(const std::string& path) {
  if (path.empty())
    throw UserError(
        diagnostic(Code::E0602, "the name of an output is empty", "give a file; is a shell variable unset?"));
  if (path == "-")
    throw UserError(diagnostic(Code::E0602, "the output '-' is no file",
                               "standard output is /dev/stdout; a file that is really called so is ./-"));
  std::error_code none;
  if (std::filesystem::is_directory(path, none))
    throw UserError(diagnostic(Code::E0602, "the output '" + path + "' is a folder",
                               "give the name of a file, in it or elsewhere"));
}

/// A command finds out before its work, and before the first of several outputs is written, that one has no place.
void refuse_without_folder(const std::string& path) {
  const std::string parent = std::filesystem::path(path).parent_path().string(), folder = parent.empty() ? "." : parent;
  struct stat there {};
  if (::stat(folder.c_str(), &there) != 0 || !S_ISDIR(there.st_mode)) {
    errno = ENOENT;
    fail(path, "finding its folder");
  }
  if (::faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) != 0) fail(path, "writing into its folder");
}

/// Who may read and write the file: as before; of a new one as the umask says.
mode_t mode_of(const std::string& path) {
  constexpr mode_t kPermissions = 0777, kNewFile = 0666;
  struct stat there {};
  if (::stat(path.c_str(), &there) == 0) return there.st_mode & kPermissions;
  const mode_t withheld = ::umask(0);  // cannot be read without setting it
  ::umask(withheld);
  return kNewFile & ~withheld;
}

/// What will take the place of a file: whole on the disk beside it, and gone unless it takes that place.
class Replacement {
 public:
  /// `path`: no link. Throws UserError, as write_whole does.
  Replacement(std::string path, std::string_view content) : path_(std::move(path)), temporary_(path_ + ".XXXXXX") {
    refuse_read_only(path_);
    const mode_t mode = mode_of(path_);
    const int file = mkstemp(temporary_.data());
    if (file < 0) fail(path_, "creating a temporary file beside it");
    const bool good = fchmod(file, mode) == 0 && write_all(file, content) && fsync(file) == 0;
    const int cause = errno;
    close(file);
    if (!good) give_up(cause);
  }
  ~Replacement() {
    if (!temporary_.empty()) std::remove(temporary_.c_str());
  }
  Replacement(Replacement&& other) noexcept
      : path_(std::move(other.path_)), temporary_(std::exchange(other.temporary_, "")) {}
  Replacement& operator=(Replacement&&) = delete;

  void take_place() {
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0) give_up(errno);
    temporary_.clear();
  }

 private:
  [[noreturn]] void give_up(int cause) {
    std::remove(std::exchange(temporary_, "").c_str());
    errno = cause;
    fail(path_, "writing");
  }

  std::string path_, temporary_;
};

/// The path without links, as far as it exists; two names of one file have the same.
std::string where(const std::string& path) {
  std::error_code unreadable;
  const std::filesystem::path whole = std::filesystem::absolute(path, unreadable);
  if (unreadable) return path;  // the current folder was deleted
  const std::filesystem::path real = std::filesystem::weakly_canonical(whole, unreadable);
  return unreadable ? path : real.string();
}

/// What a link points to, even if that does not exist yet. Throws UserError when it leads round in a circle.
std::string followed(std::string path) {
  constexpr int kMostLinks = 40;
  std::error_code none;
  for (int k = 0; k < kMostLinks && std::filesystem::is_symlink(path, none); ++k)
    path = (std::filesystem::path(path).parent_path() / std::filesystem::read_symlink(path, none)).string();
  if (!std::filesystem::is_symlink(path, none)) return path;
  errno = ELOOP;
  fail(path, "following its links");
}

}  // namespace

bool is_there(const std::string& path) {
  std::error_code none;
  return std::filesystem::exists(path, none);
}

bool is_file(const std::string& path) {
  std::error_code none;
  return std::filesystem::is_regular_file(path, none);
}

void write_whole(const std::string& path, std::string_view content) {
  refuse_no_file(path);
  if (takes_content(path)) return write_into(path, content);
  const SignalsWait wait;
  Replacement(followed(path), content).take_place();
}

void write_together(const std::vector<OutputFile>& files, const std::function<void()>& print) {
  for (const OutputFile& file : files) refuse_no_file(file.path);
  for (const OutputFile& file : files)
    if (takes_content(file.path)) write_into(file.path, file.content);
  const SignalsWait wait;
  std::vector<Replacement> made;
  for (const OutputFile& file : files)
    if (!takes_content(file.path)) made.emplace_back(followed(file.path), file.content);
  if (print) print();
  for (Replacement& replacement : made) replacement.take_place();
}

void refuse_overwriting(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs) {
  std::map<std::string, std::string> taken;  // by place: the role of what stands there
  for (const std::string& input : inputs) taken.emplace(where(followed(input)), "which it reads");
  for (const std::string& output : outputs) {
    refuse_no_file(output);
    if (takes_content(output)) continue;
    refuse_without_folder(output);
    refuse_read_only(output);
    const auto [at, fresh] = taken.emplace(where(followed(output)), "which it writes too");
    if (!fresh)
      throw UserError(diagnostic(Code::E0616,
                                 "the output '" + output + "' would destroy a file of this command, " + at->second,
                                 "choose another name for the output"));
  }
}

}  // namespace abbe
