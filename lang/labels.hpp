// Where the names of a program are defined and used, by the names alone: what an editor needs to jump to a
// definition, to list and to rename the uses and to complete a name. It reads the text as it is, so it works in programs
// that are half written, and in branches and macros that nothing runs, where the meaning (compile.hpp) has gaps.
//
// FA and F share their names, and so do TA and T, DA and D, SA and S. A label defined again is
// another definition; the one above a use is in force there.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/base/source.hpp"

namespace abbe::lang {

/// Kinds of names that are no labels, besides the variables.
inline constexpr std::string_view kJumpTarget = "()";      ///< (NAME), to which JUMPTO leads
inline constexpr std::string_view kQuotedArgument = "''";  ///< 'NAME' of a MACRO, which takes a text in its place

struct LabelUse {
  std::string kind;  ///< upper case, shared: "F" also for FA; empty for a variable or an argument of a macro
  std::string name;  ///< as written
  Span span;         ///< of the label, with its kind
  Span name_span;    ///< of the name alone
  Span statement;    ///< in which it stands, or directive
  bool definition = false;
  bool computed = false;  ///< F(H@I), or F(X) where a macro has the argument X: which label this is only a run knows
  int scope = 0;          ///< of names that hold in one macro of the text: which one, counted from 1

  bool same_label(const LabelUse& other) const;
};

/// In the order of the text; of names inside a label, the label first.
std::vector<LabelUse> label_uses(const SourceFile&);

/// The definition in force at `use`: the last one above it, itself if it is one, else the first
/// below. nullptr when there is none.
const LabelUse* definition_of(const std::vector<LabelUse>& uses, const LabelUse& use);

}  // namespace abbe::lang
