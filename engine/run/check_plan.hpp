// Whether a plan can run on a machine at all, before any virtual machine runs it.
#pragma once

#include "engine/run/run.hpp"

namespace abbe {

/// Throws UserError for what run_plan refuses of the error-free machine.
void check_plan(const plan::Plan&, const Machine&, const RunOptions&, const SourceFile& source);

}  // namespace abbe
