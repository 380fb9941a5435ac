// What is suspect in what a program asks of a machine, though an error-free machine carries it out: a move beyond the
// travel, touches from the side that FEAT does not name or along the surface, a ball that does not fit into its bore, a zone that
// the nominal part does not fit into.
#pragma once

#include <vector>

#include "engine/run/executor.hpp"

namespace abbe {

/// `observed`: of the error-free machine. Each statement is named once.
std::vector<Diagnostic> program_warnings(const Executor::Observed& observed, const plan::Plan&, const Machine&,
                                         const SourceFile&);

}  // namespace abbe
