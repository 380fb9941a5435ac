// Whether a plan can run on a machine at all, before any virtual machine runs it.
#pragma once

#include <optional>
#include <string>

#include "engine/run/run.hpp"

namespace abbe {

/// Throws UserError for what run_plan refuses of the error-free machine. What is suspect of what it does.
std::vector<Diagnostic> check_plan(const plan::Plan&, const Machine&, const RunOptions&, const SourceFile& source);

/// What even an error-free machine cannot do: an operation of the plan, and why.
struct Impossible {
  int operation = 0;
  std::string reason;
};

/// The first that it comes to; nothing when nothing stops it.
std::optional<Impossible> first_impossible(const plan::Plan&, const Machine&, const RunOptions&,
                                           const SourceFile& source);

}  // namespace abbe
