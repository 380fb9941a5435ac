// One logical line to a RawStatement: `[label =] MAJOR[/argument,argument,...]`, or a jump target
// `(NAME)`.
//
// The grammar is generic on purpose: it knows no DMIS word. What the arguments of a statement mean
// is said by the statement's signature (signature.hpp), after the major word is known, which is
// what makes precise messages possible; and one small grammar compiles in seconds where a typed
// rule per statement takes minutes.
//
// Recovery after a mistake is the next line: each line is parsed by itself.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/base/letter_case.hpp"
#include "lang/lines.hpp"

namespace abbe::lang {

/// `FA(BORE)`: kind in upper case, name as written. A bare identifier before `=` (a variable,
/// perhaps with an index: X[3]) has an empty kind.
struct LabelRef {
  std::string kind, name;
  Span span;
};

/// As the program wrote it: `FA(BORE)`, or the name alone.
std::string written(const LabelRef&);

struct RawArgument {
  enum class Kind {
    empty,
    number,
    word,        ///< CART, -ZDIR, 2D: letters and digits, perhaps with a sign
    label,       ///< FA(X), and as yet also a call of a function SIN(X)
    text,        ///< a quoted string
    several,     ///< values with nothing between them: a comma is missing
    expression,  ///< anything else
  };
  Kind kind{};
  std::string text;   ///< as written, without outer blanks; a quoted string without its quotes
  std::string word;   ///< for Kind::word: upper case, without a leading +
  double number = 0;  ///< as written, no unit applied
  LabelRef label;     ///< for Kind::label
  Span span;
  std::size_t begin = 0, end = 0;  ///< where it stands in RawStatement::code
};

struct RawStatement {
  std::optional<LabelRef> label;   ///< before the `=`
  std::string word;                ///< upper case; empty for a jump target
  std::optional<LabelRef> target;  ///< `(NAME)` alone on its line
  Span word_span, span;
  std::shared_ptr<const JoinedText> code;  ///< of the line: expressions are read off it
  std::vector<RawArgument> arguments;
  int line = 1;
  std::optional<Span> missing_slash;  ///< text that follows the word without a slash: free text, or
                                      ///< a slip of the pen
  bool usable = true;                 ///< false: something is wrong, the arguments are not to be looked at
};

/// Numbers beyond are refused: times and squares of what is computed from them stay finite.
inline constexpr double kLargestNumber = 1e20;
/// Parentheses deeper than this are refused, so that no input can exhaust the stack.
inline constexpr int kMaximumNesting = 64;

/// Nothing for a line without code, and for text that is no statement (then the sink has the
/// message).
std::optional<RawStatement> parse_statement(const LogicalLine&, const SourceFile&, Sink&);

}  // namespace abbe::lang
