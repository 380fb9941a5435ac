// What a command says beside its result: messages and progress, on stderr. The result alone goes to
// stdout.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/base/files.hpp"

namespace abbe {

/// The messages as `render` writes them, on stderr.
void print_messages(const std::vector<Diagnostic>& messages);

/// The result of a command, on stdout. Throws UserError when it cannot be written (a full disk, a
/// closed pipe).
void print_result(std::string_view text);

/// The result of a command that has other outputs, too: when it cannot be written, no file is. Throws UserError as
/// print_result and write_together do.
void print_result(std::string_view text, const std::vector<OutputFile>&);

/// Throws UserError (E0616) when an output goes to stdout, where a program that reads the result would find two texts in
/// one.
void refuse_stdout(const std::vector<std::string>& outputs);

/// What a command did, for people, on stderr.
void print_hint(std::string_view text);

/// The files among options, of which some were not given.
std::vector<std::string> files_given(std::initializer_list<std::optional<std::string>> options);

/// "1 error", "3 errors".
std::string counted(std::size_t number, std::string_view noun);

/// One line on stderr that is written over and over; nothing at all when stderr is not a terminal.
/// Gone when destroyed.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  void show(std::string_view text);

 private:
  bool terminal_, shown_ = false;
};

}  // namespace abbe
