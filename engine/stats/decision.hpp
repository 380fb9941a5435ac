// The decision rule of ISO 14253-1:2017 from simulated errors: when does a value y prove that the
// true value lies inside its tolerance limits, or outside?
//
//   p+(y) = share of the errors e with lower <= y + e <= upper
//   p-(y) = share of the errors e with lower <= y - e <= upper
//   conforms: both >= P    does not conform: both <= 1 - P, y outside    undecided: else   (P = 0.95)
//
// An error is the value of a virtual machine minus that of the error-free machine, and it counts
// with either sign. As `measured = true + e`, p- is the conformance probability of JCGM 106:2012,
// 7.2, as long as errors do not depend on the true value. The errors of a zone do: a perfect form
// can only be measured too large, an imperfect one also too small. By the triangle inequality it is
// then too small by no more than the perfect one is too large, which p+ allows for. Symmetric errors
// have p+ = p-. The rejection zone of the standard lies outside the limits: errors much larger than a
// tolerance prove nothing of a value inside it.
//
// Where the limits err too (a material condition, limits that a program computes from what it measures), the
// error counts by which a value comes nearer to its limit: e less what that limit errs, which of the lower limit may
// be another one than of the upper.
//
// The values that conform keep a guard band g from both limits, the least distance from a limit at which a value
// conforms, with either sign of the errors. The value at a distance d from the upper limit conforms with +e
// as long as e <= d by the upper limit, and d <= upper - lower + e by the lower: of the intervals of all errors P n
// must hold d. Likewise at the lower limit.
// With limits far apart that is the larger of the P-points of e and of -e: of normal errors 1.645 u.
// Nearer limits cut off both tails of the errors; g rises to 1.960 u, where a single value conforms.
#pragma once

#include <optional>
#include <string_view>

#include "engine/stats/summary.hpp"

namespace abbe {

inline constexpr std::string_view kDecisionRule = "ISO 14253-1:2017";
/// Its default for the probability of conformance, and for that of non-conformance.
inline constexpr double kProvenProbability = 0.95;

enum class Conformity { conforms, undecided, does_not_conform };

constexpr std::string_view name(Conformity conformity) {
  switch (conformity) {
    case Conformity::conforms: return "conforms";
    case Conformity::undecided: return "undecided";
    case Conformity::does_not_conform: break;
  }
  return "does not conform";
}

/// On the value `y`. `errors` must not be empty; a missing limit does not bound.
Conformity decide(double y, const JudgedSample& errors, std::optional<double> lower, std::optional<double> upper,
                  double probability = kProvenProbability);

/// g, never negative; none when no value conforms.
std::optional<double> guard_band(const JudgedSample& errors, std::optional<double> lower, std::optional<double> upper,
                                 double probability = kProvenProbability);

}  // namespace abbe
