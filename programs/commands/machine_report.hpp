// What `abbe machine show` and `abbe machine screen` find out, and how they tell it: as text for
// people and as JSON, schemas "abbe.machine_report/1" and "abbe.screening/1".
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/machine/screening.hpp"

namespace abbe {

inline constexpr std::string_view kAxisNames[] = {"x", "y", "z"};

/// A machine and the first virtual machine of a seed that satisfies its specification.
struct MachineReport {
  Machine machine;
  std::uint64_t seed = 1;
  VirtualMachines drawn;  ///< one
  std::vector<TestLine> lines;
  TestResult tested;  ///< of the drawn machine, on `lines`
  std::vector<Diagnostic> messages;
};
/// The value without the sign of what is shown as zero with two decimals.
double shown(double value);
/// d at home, in the middle and at the end of each travel (paper, Fig. 6).
std::string error_state_text(const MachineReport&);
/// The errors of all test lengths against the MPE, a plot for each test (paper, Fig. 7).
std::string length_test_text(const MachineReport&);
std::string machine_report_text(const MachineReport&);
std::string machine_report_json(const MachineReport&);

/// How the accepted machines do on one line of the virtual test.
struct LineReport {
  TestLine line;
  double median = 0, p95 = 0,
         largest = 0;  ///< over the machines, of the largest |error / MPE| of the line's lengths
};
struct ScreeningReport {
  Machine machine;
  std::uint64_t seed = 1;
  ScreeningCounts counts;
  std::vector<LineReport> lines;
  std::vector<ProbeCheck> probe;
  std::optional<SuggestedFactor> suggested;
  std::vector<Diagnostic> messages;
};
/// "5 um + 5 um/m", "5 um + 5 um/m, at most 12 um".
std::string length_mpe_text(const LengthMpe&);
nlohmann::ordered_json length_mpe_json(const LengthMpe&);
std::string screening_text(const ScreeningReport&);
std::string screening_json(const ScreeningReport&);

}  // namespace abbe
