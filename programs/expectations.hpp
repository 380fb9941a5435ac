// Does a report fulfil what the `$$! expect` lines of its program ask for?
#pragma once

#include <string>

#include "engine/report/run_report.hpp"
#include "lang/compile.hpp"

namespace abbe {

struct ExpectationVerdict {
  bool passed = false;
  std::string outcome;  ///< "u95 = 0.0037, between 0.0031 and 0.0051", or why there is no figure
};

/// Every characteristic that the expectation names must be within the bounds; the outcome shows the
/// first that is not. Quantities, mm or degrees: u; u95, the expanded uncertainty: half the width
/// of the symmetric 95 % interval; lcl, ucl; mean; value, on the error-free machine; conformance, a
/// probability. "accepted" is the share of machines that passed the screening.
ExpectationVerdict judge(const lang::Expectation&, const RunReport&);

}  // namespace abbe
