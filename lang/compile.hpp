// The front end: the text of a measurement program (DMIS, ISO 22093) to a plan.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/plan/plan.hpp"

namespace abbe::lang {

/// One `$$! expect` line.
struct Expectation {
  std::string subject;                ///< tolerance label, or "accepted" (share of machines that passed the screening)
  std::vector<std::string> features;  ///< that the line names too: expect FA(x) TA(t) ...
  int occurrence = 0;                 ///< 0: every evaluation of that tolerance; else that one
  std::string quantity;               ///< u, u95, lcl, ucl, mean, value, conformance
  std::optional<double> low, high;    ///< between a b; >= a; <= b
  int line = 0;
  std::string text;  ///< the directive as written
};

/// What the comments that start with `$$!` ask for.
struct Directives {
  std::optional<std::string> machine;
  std::optional<int> machines;
  std::optional<std::uint64_t> seed;
  std::optional<std::string> workpiece;
  Span machine_span, workpiece_span;
  std::map<std::string, std::string> answers;  ///< to PROMPT, by variable in upper case
  std::optional<Vec3> place_mm;                ///< where the program's machine coordinate system lies in W
  std::vector<Expectation> expectations;
};

/// A characteristic that the program asks for and that an error took away.
struct Lost {
  int line = 0;
  std::string feature, reason;
};

struct Compilation {
  plan::Plan plan;  ///< of the statements without errors
  Directives directives;
  std::vector<Lost> lost;
  std::vector<std::string> modules;  ///< files that INCLUD, EXTFIL and CALL read
  /// Of messages about modules, by the file and the first byte that they are about: where the program calls what stands
  /// there.
  std::map<std::pair<std::string, std::uint32_t>, Span> calls;
};

/// What a compilation needs to know beyond the program.
struct CompileOptions {
  std::map<std::string, std::string> answers;  ///< to PROMPT, by variable in any case; they win over directives
  bool only_valid = false;  ///< what can only be guessed is lost too: default touches in the place of a scan
  /// Statements of the program that no machine can carry out, by where they begin, and why: they are errors then.
  std::map<std::uint32_t, std::string> impossible = {};
};

/// Never throws on a user's text: every mistake goes to the sink, and what can be used is used. Modules are
/// read from the folder of the file.
Compilation compile(const SourceFile&, Sink&, const CompileOptions& = {});

}  // namespace abbe::lang
