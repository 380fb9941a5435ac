// The error-free machine alone, before any virtual machine runs: what it makes of a plan, and what it cannot do no machine
// can.
#pragma once

#include <utility>
#include <vector>

#include "engine/run/executor.hpp"

namespace abbe {

/// The lane as it ended, at the end of the program or trapped, and all that was observed of it.
std::pair<Lane, Executor::Observed> run_alone(const Executor&);

struct ReferenceRun {
  Lane lane;
  std::vector<OutputRecord> outputs;
  std::vector<Diagnostic> warnings;  ///< program_warnings.hpp
};

/// Throws UserError, with places in the source, where the error-free machine stops (E0304) or a touch lies outside the
/// travel (E0302). Tells the executor what its blocks need to know of the reference.
ReferenceRun reference_run(Executor&, const plan::Plan&, const Machine&, const SourceFile&);

}  // namespace abbe
