// Comments that begin with `$$!`: what only the simulator needs. A real controller skips them.
//
//   machine NAME            machines N            seed N            workpiece FILE
//   place X Y Z             where the program's machine coordinate system lies in the machine, mm whatever UNITS says
//   answer NAME=VALUE       what PROMPT gives to a variable
//   expect [FA(x) ...] TA(t) [occurrence N] QUANTITY between A B | >= A | <= B
//   expect accepted between A B
// Several may stand in one comment; `answer` and `expect` take the rest of it.
#pragma once

#include "lang/lowering.hpp"

namespace abbe::lang {

/// The word after `$$!` and what it does: for `abbe explain`.
struct DirectiveHelp {
  std::string_view word, form, help;
};
std::span<const DirectiveHelp> directives();

/// The labels that a line's directives name, and the variable of `answer` (without a kind).
std::vector<LabelRef> directive_labels(const LogicalLine&);

/// What may stand at the end of a directive that is being typed; its last word may be half written.
struct DirectiveNext {
  std::vector<DirectiveHelp> words;
  std::vector<std::string_view> kinds;  ///< of labels
};
DirectiveNext next_in_directive(const JoinedText& comment);

/// Reads a comment if it is a directive; every mistake goes to the sink.
void read_directives(const LogicalLine&, Lowering&);
/// A directive in a module is an error: what it asks for is asked of the program.
void refuse_directives(const LogicalLine&, Lowering&);
/// Expectations about tolerances that nothing evaluates are errors.
void check_expectations(Lowering&);

}  // namespace abbe::lang
