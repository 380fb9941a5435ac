// Where the labels of a program are defined and used, by their names alone: what an editor needs to
// jump to a definition, to list the uses and to complete a name. It reads the text as it is, so it
// works in programs that are half written, where the meaning (compile.hpp) has gaps.
//
// FA and F share their names, and so do TA and T, DA and D, SA and S. A label defined again is
// another definition; the one above a use is in force there.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/base/source.hpp"

namespace abbe::lang {

struct LabelUse {
  std::string kind;  ///< upper case, shared: "F" also for FA; empty for a variable
  std::string name;  ///< as written
  Span span;         ///< of the label, with its kind
  Span statement;    ///< in which it stands
  bool definition = false;

  bool same_label(const LabelUse& other) const;
};

/// In the order of the text.
std::vector<LabelUse> label_uses(const SourceFile&);

/// The definition in force at `use`: the last one above it, itself if it is one, else the first
/// below. nullptr when there is none.
const LabelUse* definition_of(const std::vector<LabelUse>& uses, const LabelUse& use);

}  // namespace abbe::lang
