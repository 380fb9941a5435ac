#include "engine/run/expression.hpp"

#include <cmath>

namespace abbe {

double apply(plan::Op1 op, double a) {
  using enum plan::Op1;
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

double apply(plan::Op2 op, double a, double b) {
  using enum plan::Op2;
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

}  // namespace abbe
