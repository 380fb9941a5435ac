// The words of the language as its own tables have them: for the formatter (which words are written
// in capitals), the editor (what may stand here) and the grammars of editors. A word that a table
// gains is known here at once.
#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lang/parser.hpp"
#include "lang/statement.hpp"

namespace abbe::lang {

/// Every minor word: of the statements, features, constructions and tolerances. Upper case.
const std::set<std::string, std::less<>>& minor_words();

/// The major words that Abbe knows and those of the standard, in alphabetical order, each once.
std::vector<std::string_view> major_words();

/// The minor words that may stand among the arguments of `word` after the ones written: those of
/// its signature, and of the kind of feature, tolerance or construction that was named. Nothing for
/// a word that is not known.
std::vector<std::string> argument_words(std::string_view word, std::span<const RawArgument> written);

/// What a label of this kind names.
struct LabelKind {
  std::string_view kind;  ///< "F", "FA", ...
  std::string_view what;  ///< "nominal of a feature"
};
/// ISO 22093, labels.
std::span<const LabelKind> label_kinds();

/// The kind that a label shares its names with: FA and F are one, TA and T, DA and D, SA and S.
std::string_view shared_kind(std::string_view kind);

}  // namespace abbe::lang
