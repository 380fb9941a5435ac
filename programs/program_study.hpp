// From a program file to a report: read, compile, settle what is asked for, study. The commands `run` and
// `test` share it.
//
// A program may carry settings in its directives (`$$! machine`, `$$! workpiece`, `$$! machines`, `$$! seed`,
// `$$! place`); the command line wins over them, and the documented defaults fill the rest.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "engine/report/study.hpp"
#include "engine/run/placement.hpp"
#include "lang/compile.hpp"

namespace abbe {

inline constexpr const char* kDefaultMachine = "coord3-mc16";
inline constexpr int kDefaultMachines = 1000;

/// What the command line may settle of a study; what is left out is up to the program and the defaults.
struct StudySettings {
  std::optional<std::string> machine;    ///< file or shipped name
  std::optional<std::string> workpiece;  ///< file
  std::optional<std::string> recording;  ///< file: errors are added to its points instead of to nominal ones
  std::optional<int> machines;
  std::optional<int> digits;  ///< significant digits of u that must be stable; chooses the number of machines
  std::optional<std::uint64_t> seed;
  bool budget = false;
  std::optional<double> coverage;  ///< of the further intervals
  EffectUse effect_use = EffectUse::left_in;
  int threads = 0;  ///< 0: all of the computer
};

struct StudyRequest {
  std::string program;
  StudySettings settings;
  bool only_valid = false;                     ///< go on without the statements that have errors
  std::map<std::string, std::string> answers;  ///< to PROMPT, by variable
};

/// A program and what its compilation gave; messages in the order of their places.
struct CompiledProgram {
  SourceFile source;
  lang::Compilation compilation;
  std::vector<Diagnostic> messages;
  bool has_errors = false;
};
CompiledProgram compile_program(const std::string& path, const lang::CompileOptions& = {});

/// A file that another file names: its path is as seen from that one.
std::string beside(const std::string& file, const std::string& path);
/// The machine to use, as read_machine takes it: what the command line chose, else what the program asks for
/// (a file beside the program or a shipped machine), else the default.
std::string machine_name(const CompiledProgram&, const std::optional<std::string>& chosen);
/// The workpiece to use: the file that the command line chose, else the one that the program asks for, its
/// path as seen from the program. Nothing when neither names one. Throws UserError as read_workpiece does.
std::optional<Workpiece> workpiece_of(const CompiledProgram&, const std::optional<std::string>& chosen);

/// The program and its modules.
std::vector<std::string> files_compiled(const CompiledProgram&);
/// A workpiece file and the temperature log that it names; nothing without a workpiece.
std::vector<std::string> files_of(const std::optional<Workpiece>&);

/// What a program is run with, whoever named it: the command line, the program or the workpiece file.
struct StudyInputs {
  std::string machine_name;  ///< as read_machine took it
  Machine machine;
  std::optional<Workpiece> workpiece;
  std::optional<Recording> recording;
  std::vector<Diagnostic> messages;  ///< of reading them
  /// that were read, the program and its modules among them: no output may take their place
  std::vector<std::string> files;
};
/// Errors of a file that a directive of the program names: where they stand in that file, else at the directive.
std::vector<Diagnostic> placed(const UserError&, const SourceFile& program, Span directive);
/// Reads each of them once. Throws UserError as read_machine, read_workpiece and read_recording do.
StudyInputs read_inputs(const CompiledProgram&, const StudySettings&);

/// Where the program stands in the machine: what it asks for, else what is found. Throws UserError as find_placement does.
Placement placement_of(const CompiledProgram&, const Machine&);

/// Takes out of the program what even an error-free machine cannot do, an evaluation by itself, any other statement with
/// all that rests on it; `lost` then says why. Compiled with these options. Returns the messages about it.
std::vector<Diagnostic> leave_out_what_is_impossible(CompiledProgram&, lang::CompileOptions, const StudyInputs&);

/// Studies a compiled program. Throws UserError: the error-free machine cannot run the program.
Study study_program(const CompiledProgram&, const StudySettings&, const StudyInputs&, const Progress& progress = {});

}  // namespace abbe
