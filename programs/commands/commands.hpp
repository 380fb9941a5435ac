// The commands of `abbe`: one options struct and one function for each, in a file of its own beside this header.
//
// options.cpp fills the struct from the command line and calls the function. A command prints its result on stdout, its
// messages on stderr (terminal.hpp), and returns the exit code. It may throw UserError (abbe.cpp renders it
// and exits with 2); anything else that escapes is a fault of ours and exits with 3.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "programs/program_study.hpp"

namespace abbe {

inline constexpr int kDone = 0;      ///< done, and the answer is yes
inline constexpr int kNo = 1;        ///< done, and the answer is no: errors found, an expectation failed
inline constexpr int kUnusable = 2;  ///< wrong usage or unusable input
inline constexpr int kFault = 3;     ///< internal fault

struct RunCommandOptions {
  StudyRequest request;
  std::string format = "text";        ///< a name of report_writers()
  std::optional<std::string> csv;     ///< where every sample goes
  std::optional<std::string> dmo;     ///< where the result file of the error-free machine goes
  std::optional<std::string> report;  ///< where the page goes
};
int run_command(const RunCommandOptions&);

struct CheckOptions {
  std::vector<std::string> paths;              ///< programs, and folders to search for them
  bool plan = false;                           ///< also print the plan of each program
  std::map<std::string, std::string> answers;  ///< to PROMPT, by variable
  std::string format = "text";                 ///< text or json
};
int check_command(const CheckOptions&);

struct TestOptions {
  std::vector<std::string> paths;    ///< programs, and folders to search for them
  std::optional<std::string> junit;  ///< where the JUnit XML goes
  StudySettings settings;
  std::map<std::string, std::string> answers;  ///< to PROMPT, by variable
};
int test_command(const TestOptions&);

struct FitOptions {
  std::string element, points;  ///< "circle"; a CSV file with the header x,y,z
  std::optional<std::array<double, 3>> normal;
  std::string format = "text";  ///< text or json
};
int fit_command(const FitOptions&);
/// The elements that it offers, those that need the fewest points first.
std::vector<std::string_view> fit_elements();

struct MachineOptions {
  std::string action;   ///< list, show, screen, init
  std::string machine;  ///< file or shipped name; for init the new file's name; empty for list
  int machines = 1000;  ///< how many accepted machines `screen` draws
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: all of the computer
  std::string format = "text";
};
int machine_command(const MachineOptions&);

struct RecordOptions {
  std::string program, output;     ///< output: where the recording goes, CSV
  std::optional<std::string> dmo;  ///< where the result file of the recorded machine goes
  std::optional<std::string> machine, workpiece;
  std::optional<std::uint64_t> seed;
  int run = 1;                                 ///< which repeat: the same machine, other noise
  int setup = 1;                               ///< which placement of the part
  std::map<std::string, std::string> answers;  ///< to PROMPT, by variable
  std::vector<std::string> with;               ///< "EFFECT" or "EFFECT:parameter=value,..."
};
int record_command(const RecordOptions&);

struct DiagnoseCommandOptions {
  std::vector<std::string> recordings;
  std::optional<std::string> program, machine, workpiece;
  std::optional<std::string> known;      ///< machine file of an earlier diagnosis
  std::optional<std::string> report;     ///< where the page goes, HTML
  std::optional<std::string> model_out;  ///< where the machine file with what was found goes
  std::optional<std::uint64_t> seed;
  int threads = 0;  ///< 0: all of the computer
  bool design_only = false, fail_on_mismatch = false;
  std::string format = "text";  ///< text or json
};
int diagnose_command(const DiagnoseCommandOptions&);

struct FormatOptions {
  std::vector<std::string> paths;  ///< programs, and folders to search for them
  bool check = false;              ///< only say which files are not formatted; then the answer is no
  bool write = false;              ///< write the files back instead of to stdout
};
int format_command(const FormatOptions&);

int lsp_command();

struct ReplOptions {
  std::optional<std::string> program;  ///< to begin with
  StudySettings settings;
};
int repl_command(const ReplOptions&);

struct ExplainOptions {
  std::optional<std::string> word;  ///< a DMIS word, an effect or a message code; none: what there is
  bool markdown = false;            ///< the whole language reference as Markdown
  std::string format = "text";      ///< text, or vega: the signature of an effect as a Vega-Lite specification
};
int explain_command(const ExplainOptions&);

}  // namespace abbe
