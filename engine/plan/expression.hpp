// Arithmetic of plan expressions: the language folds constants with it and the executor evaluates columns
// with it, so a value is the same to the bit whether it was known when the program was compiled or only while
// it ran.
//
// Functions are those of the C library on doubles; angles are in radians. MOD has the sign of its first
// operand, rounding goes to the nearest whole number with halves away from zero (ISO 22093, intrinsic
// functions; the same as Fortran's).
#pragma once

#include <cmath>

#include "engine/base/arguments.hpp"
#include "engine/plan/plan.hpp"

namespace abbe::plan {

/// How many numbers an expression may hold at once. The language refuses expressions that need more.
inline constexpr int kExpressionStack = 64;

/// One operator; fails with the reason (static text) for a division by zero, a root of a negative number and the like.
Outcome<double> apply(Op1, double);
Outcome<double> apply(Op2, double left, double right);

/// How many numbers the expression holds at most while it is evaluated.
int stack_depth(const Expression&);

/// The constant that the expression is; nothing when it holds a column.
inline const double* constant(const Expression& expression) {
  const auto* push = expression.size() == 1 ? std::get_if<PushConstant>(&expression[0]) : nullptr;
  return push ? &push->value : nullptr;
}

/// The element of an array that a 1-based index names, as an offset from its first column; -1 outside the array.
inline int element_offset(double index, int count) {
  return index >= 1 && index < count + 1.0 ? static_cast<int>(index) - 1 : -1;
}

inline constexpr const char* kOutsideArray = "an index lies outside its array";

/// Evaluates on one lane. `column(id)` gives the value of a column there; NaN marks one that was never
/// assigned. Never returns NaN or infinity.
template <class Column>
Outcome<double> evaluate(const Expression& expression, const Column& column) {
  double stack[kExpressionStack];
  int top = 0;
  const auto read = [&](ColumnId id) {
    const double v = column(id);
    return std::isnan(v) ? Outcome<double>::failed("a variable has no value on the path that was taken")
                         : Outcome<double>{v, nullptr};
  };
  for (const Instruction& instruction : expression) {
    Outcome<double> result;
    if (const auto* push = std::get_if<PushConstant>(&instruction)) {
      result.value = push->value;
      ++top;
    } else if (const auto* variable = std::get_if<PushColumn>(&instruction)) {
      result = read(variable->column);
      ++top;
    } else if (const auto* element = std::get_if<PushElement>(&instruction)) {
      const int offset = element_offset(stack[top - 1], element->count);
      result =
          offset < 0 ? Outcome<double>::failed(kOutsideArray) : read({element->first.value + offset * element->stride});
    } else if (const auto* op1 = std::get_if<Op1>(&instruction)) {
      result = apply(*op1, stack[top - 1]);
    } else {
      --top;
      result = apply(std::get<Op2>(instruction), stack[top - 1], stack[top]);
    }
    if (!result) return result;
    ABBE_CHECK(top >= 1 && top <= kExpressionStack);
    stack[top - 1] = result.value;
  }
  ABBE_CHECK(top == 1);
  return {stack[0], nullptr};
}

}  // namespace abbe::plan
