// Expressions of a plan, evaluated on one lane.
#pragma once

#include <cmath>

#include "engine/base/arguments.hpp"
#include "engine/plan/plan.hpp"

namespace abbe {

/// `column(id)` gives the value of a column on that lane. Fails (reason in plain words) on a division by zero, a root of a negative
/// number and the like: never returns NaN or infinity.
template <class Column>
Outcome<double> evaluate(const plan::Expression& expression, const Column& column);

/// One operator. NaN marks a domain error.
double apply(plan::Op1, double);
double apply(plan::Op2, double left, double right);

template <class Column>
Outcome<double> evaluate(const plan::Expression& expression, const Column& column) {
  double stack[64];
  int top = 0;
  for (const plan::Instruction& instruction : expression) {
    if (const auto* constant = std::get_if<plan::PushConstant>(&instruction)) {
      ABBE_CHECK(top < 64);
      stack[top++] = constant->value;
    } else if (const auto* push = std::get_if<plan::PushColumn>(&instruction)) {
      ABBE_CHECK(top < 64);
      stack[top++] = column(push->column);
    } else if (const auto* op1 = std::get_if<plan::Op1>(&instruction)) {
      ABBE_CHECK(top >= 1);
      stack[top - 1] = apply(*op1, stack[top - 1]);
    } else {
      ABBE_CHECK(top >= 2);
      --top;
      stack[top - 1] = apply(std::get<plan::Op2>(instruction), stack[top - 1], stack[top]);
    }
    if (!std::isfinite(stack[top - 1])) return Outcome<double>::failed("arithmetic has no result (division by zero or out of range)");
  }
  ABBE_CHECK(top == 1);
  return {stack[0]};
}

}  // namespace abbe
