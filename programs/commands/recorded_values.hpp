// Recordings of values on the command line: which programs they come from, read and compiled.
#pragma once

#include "engine/diagnose/values/value_diagnosis.hpp"
#include "programs/commands/commands.hpp"

namespace abbe {

/// Whether these recordings are tables of values, not of touches. Throws UserError when several files are and
/// so cannot be one machine's, and of files that are no recordings.
bool are_values(const std::vector<SourceFile>& files);

/// The machine that one of these recordings names, as read_machine takes it: a file beside one of them, a
/// shipped machine, or a file as seen from here; empty: `named` is. Throws UserError when there is none of
/// these.
std::string recorded_machine(const std::string& named, const std::vector<std::string>& recordings);

/// The name in that machine's file; nothing where `named` is empty or no file of it is here.
std::optional<std::string> name_of_recorded_machine(const std::string& named,
                                                    const std::vector<std::string>& recordings);

/// A recording of values with everything that its diagnosis needs.
class RecordedValues {
 public:
  /// `program`: of rows that name none. Programs that rows name lie as seen from the file.
  /// `messages`: what is to be said of them. Throws UserError as read_value_recording and usable_program do, and of a
  /// result file that is not whole.
  RecordedValues(const SourceFile& file, const std::optional<std::string>& program, std::vector<Diagnostic>& messages);
  /// The machine that the recording or its first program names; empty: none does. Throws UserError as
  /// recorded_machine does.
  std::string machine() const;
  /// In the order in which rows name them first.
  const std::vector<CompiledProgram>& programs() const { return programs_; }
  /// The programs and their modules.
  std::vector<std::string> files() const;
  Diagnosis diagnosis(const Machine&, const DiagnoseOptions&) const;

 private:
  ValueRecording recording_;
  std::vector<std::string> names_;         ///< as the rows say
  std::vector<CompiledProgram> programs_;  ///< in the order of names_
};

}  // namespace abbe
