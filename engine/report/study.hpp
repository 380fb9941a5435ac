// A study: one plan on one kind of machine, from the drawing of the virtual machines to the figures
// of the report.
//
// 1. Virtual machines that pass the acceptance test are drawn (engine/machine/screening).
// 2. The plan runs on all of them with every contributor acting: the samples from which all figures
//    come.
// 3. It runs once more with each contributor alone, on the same machines and with the same random
//    numbers: the variances of these runs share out the uncertainty.
//
// The number of machines is given, or chosen by JCGM 101:2008, 7.9.4: blocks of 10 000 machines are
// added until twice the standard error of the mean, of u and of both limits is within the numerical
// tolerance of the digits asked for. The runs of step 3 then use the first block. Nothing depends
// on the number of threads.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "engine/base/progress.hpp"
#include "engine/machine/machine.hpp"
#include "engine/report/run_report.hpp"

namespace abbe {

/// JCGM 101:2008, 7.9.4 b: M = max(J, 10^4), where J = 100/(1-p) is more for a coverage p above 0.99.
inline constexpr int kBlockMachines = 10'000;

struct StudyOptions {
  std::uint64_t seed = 1;
  int machines = 1000;        ///< at least 2; without meaning when `digits` is set
  std::optional<int> digits;  ///< 1 or 2 significant digits of u that must be stable
  int max_blocks = 100;       ///< blocks of 10^4 after which that is given up: the 10^6 trials of JCGM 101:2008, 7.2.2
  int threads = 1;
  bool budget = false;             ///< also each error function alone, and the alignment against the features
  std::optional<double> coverage;  ///< in (0, 1): also report the intervals of this probability
  EffectUse effect_use = EffectUse::left_in;
  Vec3 placement_mm;                     ///< RunOptions::placement_mm
  const Workpiece* workpiece = nullptr;  ///< RunOptions::workpiece
  const Recording* recorded = nullptr;   ///< RunOptions::recorded
};

struct Study {
  RunReport report;  ///< without the version and what the compilation lost and said: the caller adds them
  RunResult result;  ///< with every contributor acting
  std::vector<std::uint32_t> candidates;  ///< of each machine of `result`: the index that keys its random numbers
};

/// Throws UserError (E0603) where `machines`, `digits` or `coverage` make no sense.
void check_options(const StudyOptions&);

/// Throws UserError as screened_machines and run_plan do, and as check_options does.
Study run_study(const plan::Plan&, const Machine&, const StudyOptions& options, const SourceFile& source,
                const Progress& progress = {});

/// Every sample of a study as CSV (RFC 4180):
/// machine,candidate,characteristic,line,occurrence,unit,reference,value. Angles in degrees, numbers so
/// that they read back exactly.
std::string samples_csv(const plan::Plan&, const Study&);

}  // namespace abbe
