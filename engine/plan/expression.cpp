#include "engine/plan/expression.hpp"

#include <algorithm>

namespace abbe::plan {

namespace {

double value_of(Op1 op, double a) {
  using enum Op1;
  switch (op) {
    case negate: return -a;
    case logical_not: return a == 0;
    case abs: return std::fabs(a);
    case acos: return std::acos(a);
    case asin: return std::asin(a);
    case atan: return std::atan(a);
    case cos: return std::cos(a);
    case sin: return std::sin(a);
    case tan: return std::tan(a);
    case exp: return std::exp(a);
    case ln: return std::log(a);
    case log10: return std::log10(a);
    case sqrt: return std::sqrt(a);
    case truncate: return std::trunc(a);
    case round: return std::round(a);
  }
  ABBE_CHECK(false);
}

double value_of(Op2 op, double a, double b) {
  using enum Op2;
  switch (op) {
    case add: return a + b;
    case subtract: return a - b;
    case multiply: return a * b;
    case divide: return a / b;
    case power: return std::pow(a, b);
    case modulo: return std::fmod(a, b);
    case atan2: return std::atan2(a, b);
    case sign: return std::copysign(std::fabs(a), b);
    case minimum: return std::fmin(a, b);
    case maximum: return std::fmax(a, b);
    case equal: return a == b;
    case not_equal: return a != b;
    case less: return a < b;
    case less_equal: return a <= b;
    case greater: return a > b;
    case greater_equal: return a >= b;
    case logical_and: return a != 0 && b != 0;
    case logical_or: return a != 0 || b != 0;
  }
  ABBE_CHECK(false);
}

const char* failure_of(Op1 op) {
  switch (op) {
    case Op1::sqrt: return "the square root of a negative number";
    case Op1::ln:
    case Op1::log10: return "the logarithm of a number that is not positive";
    case Op1::asin:
    case Op1::acos: return "the arc of a sine or cosine outside -1 to 1";
    default: return "a result that is too large";
  }
}

const char* failure_of(Op2 op, double b) {
  if ((op == Op2::divide || op == Op2::modulo) && b == 0) return "a division by zero";
  if (op == Op2::power) return "a power that has no value";
  return "a result that is too large";
}

}  // namespace

Outcome<double> apply(Op1 op, double a) {
  const double v = value_of(op, a);
  return std::isfinite(v) ? Outcome<double>{v, nullptr} : Outcome<double>::failed(failure_of(op));
}

Outcome<double> apply(Op2 op, double a, double b) {
  const double v = value_of(op, a, b);
  return std::isfinite(v) ? Outcome<double>{v, nullptr} : Outcome<double>::failed(failure_of(op, b));
}

int stack_depth(const Expression& expression) {
  int depth = 0, greatest = 0;
  for (const Instruction& i : expression) {
    depth += std::holds_alternative<PushConstant>(i) || std::holds_alternative<PushColumn>(i) ? 1
        : std::holds_alternative<Op2>(i)                                                      ? -1
                                                                                              : 0;
    greatest = std::max(greatest, depth);
  }
  return greatest;
}

}  // namespace abbe::plan
