// What `abbe machine show` and `abbe machine screen` find out, and how they tell it: as text for
// people and as JSON, schemas "abbe.machine_report/1" and "abbe.screening/1".
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/machine/screening.hpp"

namespace abbe {

/// A machine and the first virtual machine of a seed that satisfies its specification.
struct MachineReport {
  Machine machine;
  std::uint64_t seed = 1;
  VirtualMachines drawn;  ///< one
  std::vector<Diagnostic> messages;
};
std::string machine_report_text(const MachineReport&);
std::string machine_report_json(const MachineReport&);

/// How the accepted machines do on one line of the virtual test.
struct LineReport {
  TestLine line;
  std::array<double, 5> mpe_mm{};
  double median = 0, p95 = 0,
         largest = 0;  ///< over the machines, of the largest |error / MPE| of the line's lengths
};
struct ScreeningReport {
  Machine machine;
  std::uint64_t seed = 1;
  ScreeningCounts counts;
  std::vector<LineReport> lines;
  SuggestedFactor suggested;
  std::vector<Diagnostic> messages;
};
std::string screening_text(const ScreeningReport&);
std::string screening_json(const ScreeningReport&);

}  // namespace abbe
