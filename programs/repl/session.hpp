// An interactive session: statements one at a time, on the same machinery as everything else. Each
// entry is compiled as the end of the program that has been entered so far, so a session can do
// what a program can, and what it saves runs elsewhere. An entry with an error is reported and
// dropped; the session goes on as if it had not been typed. So is one that the error-free machine cannot
// do, and a machine that cannot do what was entered is not taken: a session can always be run.
//
// An entry is a statement, or a whole block: inside MEAS..ENDMES, IF..ENDIF and the like, and
// behind a `$` at the end of a line, the session waits for the rest. When an entry evaluates
// something (OUTPUT, EVAL) the whole program runs on the virtual machines and the new results are
// shown.
//
// Lines that begin with a dot are commands to the session itself.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "engine/plan/plan.hpp"
#include "programs/program_study.hpp"

namespace abbe {

class Session {
 public:
  explicit Session(StudySettings settings) : settings_(std::move(settings)) {}

  /// What one line of input brings: text for the person; results and messages alike.
  std::string enter(const std::string& line);
  /// Forgets the beginning of an entry.
  std::string drop();
  /// The program in a file becomes the program of the session.
  std::string load(const std::string& path);

  bool finished() const { return finished_; }
  /// Whether the session waits for the rest of an entry.
  bool waiting() const { return !pending_.empty(); }
  /// The words that may stand where `line` ends.
  std::vector<std::string> completions(const std::string& line) const;

  /// The commands that begin with a dot, for help and completion.
  struct Command {
    std::string_view word, form, help;
    std::string (Session::*run)(const std::vector<std::string>& operands);
  };
  static const std::vector<Command>& commands();

 private:
  std::string command(const std::string& line);
  /// Takes the text if it has no error, and evaluates what it asks for.
  std::string entry(const std::string& text);
  /// What the error-free machine says that has not been told. Throws UserError when it cannot run the program.
  std::string tried(const CompiledProgram&);
  /// Runs the program and shows its characteristics from `first` on.
  std::string evaluate(const CompiledProgram&, std::size_t first);
  std::string tell_once(const std::vector<Diagnostic>&);
  CompiledProgram compiled(const std::string& text) const;
  std::vector<plan::SensorDef> candidates(const std::vector<std::string>& labels) const;
  std::string text() const;

  std::string help(const std::vector<std::string>&);
  std::string list(const std::vector<std::string>&);
  std::string run(const std::vector<std::string>&);
  std::string undo(const std::vector<std::string>&);
  std::string machine(const std::vector<std::string>&);
  std::string machines(const std::vector<std::string>&);
  std::string sensor(const std::vector<std::string>&);
  std::string compare(const std::vector<std::string>&);
  std::string load_command(const std::vector<std::string>&);
  std::string save(const std::vector<std::string>&);
  std::string quit(const std::vector<std::string>&);

  StudySettings settings_;
  std::vector<std::string> entries_;  ///< accepted, with their line ends
  std::string pending_;               ///< the beginning of an entry
  std::set<std::string> told_;        ///< what runs had to say and has been shown
  std::string path_;                  ///< of the program that was loaded or saved
  bool finished_ = false;
};

/// All messages of an error.
std::string rendered(const UserError&);

}  // namespace abbe
