// Signatures: what arguments a statement takes, as one line of text (notation in
// engine/base/arguments.hpp).
//
// The same text matches the arguments of a program, says in a message what was expected, and prints
// the help and the language reference, so the three cannot drift apart. Two marks beyond the
// notation of arguments.hpp:
// - `...`: whatever follows; a kind named earlier publishes the signature for it, or it has no meaning here
// - `l:label`: any label whatever its kind, for words that are understood and skipped
// - `c:condition`: a logical value
// - `v:value`: any value
// A number, condition or value may be an expression over variables. Words are upper case, types lower case;
// that tells `side:INNER|OUTER` from `x:length`.
//
// Matching takes the first alternative that fits and never goes back into an option it has taken.
// When nothing fits, the mismatch is the furthest argument reached and everything that could have
// stood there.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "lang/expression.hpp"
#include "lang/units.hpp"

namespace abbe::lang {

enum class ValueType {
  number,
  length,
  angle,
  integer,
  text,
  feature,
  datum,
  tolerance,
  sensor,
  frame,
  label,
  word,
  condition,  ///< a logical value
  value       ///< any value
};

struct SignatureItem {
  enum class Kind { words, value, optional, repeat, alternatives, rest };
  Kind kind{};
  std::string name;                                  ///< empty for a literal word
  ValueType type{};                                  ///< for Kind::value
  std::vector<std::string> words;                    ///< for Kind::words
  std::vector<std::vector<SignatureItem>> branches;  ///< for the other kinds
};
using Signature = std::vector<SignatureItem>;

/// Throws InternalError for text that is not in the notation: signatures are part of the program,
/// not of its input.
Signature parse_signature(std::string_view text);

struct MatchedValue {
  std::string name;
  ValueType type{};
  double number = 0;  ///< mm, rad or as written
  /// of a condition or value; of a number only when it depends on what is measured, in units as above
  std::optional<Value> value;
  plan::ColumnId column;  ///< then also where a statement finds it
  std::string text;       ///< word in upper case, text, or the name of a label
  LabelRef label;         ///< for labels
  Span span;
};

/// The named values in the order in which they were written.
struct Match {
  std::vector<MatchedValue> values;
  std::size_t used = 0;  ///< arguments consumed: where `...` begins, or all

  const MatchedValue* find(std::string_view name) const;
  bool has(std::string_view name) const { return find(name) != nullptr; }
  double number(std::string_view name, double otherwise = 0) const;
  std::string text(std::string_view name, std::string_view otherwise = "") const;
};

struct Mismatch {
  std::size_t argument = 0;           ///< index; the number of arguments when one is missing at the end
  std::vector<std::string> expected;  ///< descriptions; empty when an argument is one too many
  std::vector<std::string> words;     ///< the words that could have stood there
  std::optional<Mistake> mistake;     ///< the argument is an expression that has no value: why
  bool complete = false;              ///< what stands before the argument is all that is needed
};

/// The value of an argument that is an expression.
using Evaluator = std::function<Evaluation(const RawArgument&)>;

std::variant<Match, Mismatch> match(const Signature&, std::span<const RawArgument>, const Units&,
                                    const Evaluator& = {});

/// The message for a mismatch, at the argument, or at `statement` when an argument is missing.
/// `what` is the statement as the user knows it ("FEAT/CIRCLE"); `first` the number of its
/// arguments before the ones matched.
Diagnostic describe(const Mismatch&, std::span<const RawArgument>, std::string_view what, std::size_t first,
                    Span statement, const SourceFile&);

}  // namespace abbe::lang
