#include "engine/run/check_plan.hpp"

#include "engine/run/reference_run.hpp"

namespace abbe {

std::vector<Diagnostic> check_plan(const plan::Plan& plan, const Machine& machine, const RunOptions& options,
                                   const SourceFile& source) {
  Executor executor(plan, machine, options, source);
  return reference_run(executor, plan, machine, source).warnings;
}

std::optional<Impossible> first_impossible(const plan::Plan& plan, const Machine& machine, const RunOptions& options,
                                           const SourceFile& source) {
  const LaneTrap trap = run_alone(Executor(plan, machine, options, source)).first.trap;
  if (trap.reason.empty()) return std::nullopt;
  return Impossible{trap.operation, trap.reason};
}

}  // namespace abbe
