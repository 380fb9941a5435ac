// Everything a report of `abbe run` may show, as plain data. Writers (engine/report/writers) turn it into text, JSON, ...
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/machine/screening.hpp"
#include "engine/run/run.hpp"
#include "engine/stats/summary.hpp"

namespace abbe {

/// One characteristic; lengths mm, angles degrees: the unit that `unit` names.
struct CharacteristicReport {
  std::vector<std::string> features;
  std::string tolerance, kind, unit;
  int line = 0, occurrence = 1;
  double nominal = 0, reference = 0;
  Summary summary;                        ///< of the values
  double lcl = 0, ucl = 0;                ///< limits of the 95 % interval minus reference
  std::optional<double> lower, upper;     ///< tolerance limits of the value
  std::optional<double> conformance_probability;
  struct Contribution { std::string name; double share = 0; };
  std::vector<Contribution> contributions;  ///< shares of variance, sum 1 (all 0 when nothing varies)
  int trapped = 0;                        ///< machines that did not reach it
};

struct Influence {
  std::string name, status;               ///< "modelled", "bounded", "not modelled"
};

struct LostCharacteristic {
  int line = 0;
  std::string feature, reason;
};

struct RunReport {
  std::string program, machine, version;
  std::uint64_t seed = 1;
  ScreeningCounts machines;
  std::vector<CharacteristicReport> characteristics;
  std::vector<LostCharacteristic> lost;
  std::vector<Influence> influences;
  std::vector<Trap> traps;
  std::vector<Diagnostic> messages;
};

/// Turns samples into the figures of the report. `alone[k]` is the run in which only contributor k acted.
struct ContributorRun {
  std::string name;
  RunResult result;
};
std::vector<CharacteristicReport> characteristic_reports(const plan::Plan&, const RunResult&, const std::vector<ContributorRun>& alone);

}  // namespace abbe
