// One line after the other from the person at the keyboard. On a terminal with editing, history and
// completion (libedit, when the program was built with it); from a pipe or a file plainly, without
// a prompt, so that a session can be scripted.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace abbe {

/// The words that may stand where `line` ends.
using Completer = std::function<std::vector<std::string>(const std::string& line)>;

class LineEditor {
 public:
  explicit LineEditor(Completer);
  ~LineEditor();

  struct Line {
    std::string text;      ///< without its end
    bool dropped = false;  ///< by ctrl-C, with the entry that it belongs to
  };
  /// The next line; nothing when the input ends.
  std::optional<Line> read(const std::string& prompt);
  /// Whether a person sees the prompts.
  bool interactive() const { return interactive_; }

 private:
  struct Terminal;
  std::optional<std::string> read_plainly(const std::string& prompt);

  bool interactive_;
  std::unique_ptr<Terminal> terminal_;  ///< null without libedit
};

/// What completes the last word of `line`, given the words that may stand there: what all that
/// begin with it have in common beyond it.
std::string completion_of(const std::string& line, const std::vector<std::string>& words);

}  // namespace abbe
