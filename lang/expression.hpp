// Expressions of the language (ISO 22093, expressions and intrinsic functions), read off an argument of a statement.
//
// Precedence, highest first: functions, elements and parentheses; ** (right to left); signs; * /; + -; comparisons
// .EQ. .NE. .LT. .LE. .GT. .GE.; .NOT.; .AND.; .OR. Division of whole numbers is not cut off; an assignment to an INTGR
// variable is. Angles of functions are in radians whatever UNITS says.
//
// There is no tree: a statement in a loop is lowered once for every turn, with the values of that turn, so
// reading the text and evaluating it are one pass. What is known folds; the rest becomes a plan expression
// (value.hpp).
#pragma once

#include <functional>
#include <string>
#include <variant>

#include "engine/base/diagnostic.hpp"
#include "lang/parser.hpp"
#include "lang/value.hpp"

namespace abbe::lang {

/// Why an expression has no value, and where: bytes of the joined text of the statement.
struct Mistake {
  Code code{};
  std::size_t begin = 0, end = 0;
  std::string message, help, replacement;
  bool of_variable = false;  ///< of one that is declared, so that its name is not meant as a word
};

/// Where an expression finds its variables. Both throw Mistake without a place; the reader adds it.
class Names {
 public:
  virtual ~Names() = default;
  /// The value of a variable, or of its element; nothing when there is no variable of that name.
  virtual std::optional<Value> variable(std::string_view name, const std::optional<Value>& index) = 0;
  /// A declared name near to this one, or "".
  virtual std::string near(std::string_view name) = 0;
  virtual Texts& texts() = 0;
};

using Evaluation = std::variant<Value, Mistake>;

/// The value of the bytes [begin, end) of a statement's joined text.
Evaluation evaluate(std::string_view text, std::size_t begin, std::size_t end, Names&);

/// How many numbers and operators an expression over measured values may have: a few functions of vectors that take
/// each other's results would otherwise fill any memory.
inline constexpr std::size_t kLargestExpression = 10'000;

/// `left op right` of two plan expressions, folded when both are constants; throws Mistake without a place
/// when there is no result, or when the expression needs more memory than a machine has for it.
plan::Expression combine(plan::Op2, plan::Expression left, const plan::Expression& right);
plan::Expression combine(plan::Op1, plan::Expression operand);

}  // namespace abbe::lang
