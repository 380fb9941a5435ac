#include "programs/terminal.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace abbe {

namespace {

constexpr const char* kEraseLine = "\r\033[K";

}  // namespace

void print_messages(const std::vector<Diagnostic>& messages) {
  for (const Diagnostic& d : messages) std::fputs(render(d).c_str(), stderr);
}

std::vector<std::string> files_given(std::initializer_list<std::optional<std::string>> options) {
  std::vector<std::string> files;
  for (const std::optional<std::string>& file : options)
    if (file) files.push_back(*file);
  return files;
}

std::string counted(std::size_t number, std::string_view noun) {
  return fmt::format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

void print_result(std::string_view text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!written)
    throw UserError(diagnostic(Code::E0602, std::string("cannot write the result to stdout: ") + std::strerror(errno),
                               "check the disk, or the program that reads the result"));
}

void print_result(std::string_view text, const std::vector<OutputFile>& files) {
  write_together(files, [&] { print_result(text); });
}

void refuse_stdout(const std::vector<std::string>& outputs) {
  struct stat result {};
  // of what goes to /dev/null nobody reads anything
  if (::fstat(STDOUT_FILENO, &result) != 0 || (S_ISCHR(result.st_mode) && isatty(STDOUT_FILENO) == 0)) return;
  for (const std::string& output : outputs)
    if (struct stat there{};
        ::stat(output.c_str(), &there) == 0 && there.st_dev == result.st_dev && there.st_ino == result.st_ino)
      throw UserError(diagnostic(
          Code::E0616, fmt::format("the output '{}' would go where the result goes, two texts in one", output),
          "give it a file of its own, or leave out --format"));
}

void print_hint(std::string_view text) { std::fwrite(text.data(), 1, text.size(), stderr); }

ProgressLine::ProgressLine() : terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (shown_) std::fputs(kEraseLine, stderr);
}

void ProgressLine::show(std::string_view text) {
  if (!terminal_) return;
  std::fprintf(stderr, "%s%.*s ...", kEraseLine, static_cast<int>(text.size()), text.data());
  shown_ = true;
}

}  // namespace abbe
