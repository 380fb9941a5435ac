// Whether a plan can run on a machine at all, before any virtual machine runs it.
#pragma once

#include <optional>
#include <string>

#include "engine/run/run.hpp"

namespace abbe {

/// Throws UserError for what run_plan refuses of the error-free machine.
void check_plan(const plan::Plan&, const Machine&, const RunOptions&, const SourceFile& source);

/// An evaluation that gives no value even on an error-free machine: an operation of the plan, and why.
struct NoValue {
  int operation = 0;
  std::string reason;
};

/// The first one that the error-free machine comes to; nothing when it is stopped by nothing, or by something else.
std::optional<NoValue> evaluation_without_value(const plan::Plan&, const Machine&, const RunOptions&,
                                                const SourceFile& source);

}  // namespace abbe
