// Warnings of a diagnosis that are no finding: what is odd about the recording, or the machine, as a whole.
#pragma once

#include <string>

#include "engine/base/diagnostic.hpp"
#include "engine/diagnose/baseline/length_errors.hpp"
#include "engine/diagnose/case.hpp"

namespace abbe::diagnose {

/// Where so many touches lie further out than this, and no effect explains it, the targets are not those of
/// the part: no machine does so much.
inline constexpr double kBeyondMachines_mm = 0.1, kHalfOfThem = 0.5, kNineTenths = 0.9;
/// How far from their targets that share of the touches lies at most.
double within_mm(const RecordedTouches&, double share);
/// How many times what is uncertain of a known machine a recording may ask for beside what was found. Of 40
/// recordings of the same machine none asked for more than 1.7.
inline constexpr double kAnotherMachine = 3;
/// Whether touches scatter so much more than the machine file says that it is no chance, and worth telling.
bool scatters_more(const BaselineSummary&, int touches);

/// W0704: `share` of the touches lies too far from the targets.
Diagnostic not_its_targets(const RecordedTouches&, double share, const std::string& file);
/// W0717
Diagnostic nothing_but_targets(const std::string& file);
/// W0716; `beside_names`: something else was named.
Diagnostic beyond_its_specification(const LengthError&, bool beside_names, const std::string& file);
/// W0723
Diagnostic large_errors(double times, const Deviations& rms, const std::string& file);
/// W0720
Diagnostic another_machine(double times, const std::string& file);
/// W0730
Diagnostic more_scatter(const BaselineSummary&, const std::string& file);

}  // namespace abbe::diagnose
