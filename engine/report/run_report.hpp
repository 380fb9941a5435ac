// Everything a report of `abbe run` may show, as plain data. Writers (engine/report/writers) turn
// it into text, JSON, ...
//
// The figures of one characteristic follow GUM and JCGM 101: the value of the error-free machine as
// reference, the mean and standard uncertainty u of the values of all virtual machines, and the 95
// % limits, which are given relative to the reference as Table 3 of the paper prints them (LCL,
// UCL).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/machine/screening.hpp"
#include "engine/run/run.hpp"
#include "engine/stats/decision.hpp"
#include "engine/stats/histogram.hpp"
#include "engine/stats/summary.hpp"

namespace abbe {

/// One characteristic; lengths mm, angles degrees: the unit that `unit` names.
struct CharacteristicReport {
  std::vector<std::string> features;
  std::string tolerance, kind, unit;
  int line = 0;
  int occurrence = 1;  ///< among the evaluations of these labels that this line makes
  plan::CharacteristicId characteristic;
  int evaluation = 1;  ///< which of the characteristic's in the course of the program: Samples::occurrence
  double nominal = 0;
  std::optional<double> reference;  ///< none where a condition sends the error-free machine elsewhere
  Summary summary;                  ///< of the values
  /// false: nothing that is modelled makes the value vary, a circle through three touches has no form, and no touch shows
  /// where a bore lies along itself: its u is unknown and not 0, and nothing is decided on it
  bool varies = true;
  Histogram histogram;             ///< of the values
  std::optional<double> lcl, ucl;  ///< limits of the 95 % interval minus reference
  /// The interval of another coverage probability, of the values; none: not asked for.
  struct CoverageInterval {
    double coverage = 0.95;
    Interval symmetric, shortest;  ///< JCGM 101, 7.7
  };
  std::optional<CoverageInterval> interval;
  std::optional<double> lower, upper;  ///< tolerance limits of the value
  std::optional<double> conformance_probability;
  /// What the reference, taken for a measured value, proves (engine/stats/decision.hpp).
  struct Decision {
    Conformity verdict = Conformity::undecided;
    std::optional<double> guard_band;    ///< none: no value conforms
    std::optional<double> lower, upper;  ///< acceptance limits, where the tolerance has limits
    std::optional<double>
        tolerance_to_uncertainty;  ///< over half of the 95 % interval; a zone begins at 0; none: no value conforms
  };
  std::optional<Decision> decision;  ///< none without limits or without a reference
  struct Contribution {
    std::string name;
    double share = 0;
  };
  std::vector<Contribution>
      contributions;  ///< shares of variance, sum 1; all 0 when nothing varies, empty when unknown
  struct BudgetLine {
    std::string name;
    double share = 0, u = 0;  ///< share of the variance; standard uncertainty in `unit`
  };
  std::vector<BudgetLine> budget;           ///< each source alone, shares sum to 1; empty: not asked for
  std::vector<BudgetLine> alignment_split;  ///< "alignment", "feature" and what is left (budget.hpp)
  int evaluated = 0;                        ///< machines that evaluated it: all figures are theirs
  int trapped = 0;                          ///< machines that stopped before they could
  int elsewhere = 0;                        ///< machines that a condition on measured values sent past it
};

/// What the figures of a report hold of an influence (engine/influences).
enum class InfluenceStatus { not_modelled, modelled, bounded };
/// "not modelled", "modelled", "bounded"
std::string_view name(InfluenceStatus);

struct Influence {
  std::string name;
  InfluenceStatus status = InfluenceStatus::not_modelled;
  double at_most_um = 0;    ///< of a bounded one: the greatest error of a touch along the normal
  std::string source = {};  ///< who says so
};

struct LostCharacteristic {
  int line = 0;
  std::string feature, reason;
  bool operator==(const LostCharacteristic&) const = default;
};

struct RunReport {
  std::string program, machine, version;
  std::optional<std::string> workpiece;  ///< its name; none: exactly nominal, at 20 degrees C
  bool recorded_points = false;          ///< errors were added to recorded points, not to nominal ones
  std::optional<EffectUse> effect_use;   ///< none: the machine file has no effects
  std::uint64_t seed = 1;
  double cycle_time_s = 0;  ///< estimated, of one run of the program (RunResult::cycle_time_s)
  ScreeningCounts machines;
  std::vector<CharacteristicReport> characteristics;
  std::vector<LostCharacteristic> lost;
  std::vector<Influence> influences;
  std::vector<Trap> traps;
  std::vector<Diagnostic> messages;
};

/// The run in which only one contributor acted, on the same machines and with the same random
/// numbers.
struct ContributorRun {
  std::string name;
  RunResult result;
};
/// The further runs that a budget needs, on the same machines and with the same random numbers.
struct BudgetRuns {
  std::vector<ContributorRun> alone;  ///< each source
  RunResult alignment, feature;       ///< errors only on touches of the one or the other kind
};
/// Of each entry of `samples`, which evaluation of its labels in its line it is: 1, 2, ... The turns of
/// a loop that is written out, and the calls of a macro, are characteristics of their own in the plan;
/// a reader sees the same labels again.
std::vector<int> occurrences(const plan::Plan&, const std::vector<Samples>& samples);

/// Turns samples into the figures of the report; angles become degrees here. Characteristics that
/// fewer than two machines reached have no figures and are left out. A contributor's share is the
/// variance of its own run over the sum of those variances; what is below smallest_u (budget.hpp)
/// counts as 0. With `coverage` each has an interval of that probability.
std::vector<CharacteristicReport> characteristic_reports(const plan::Plan&, const RunResult&,
                                                         const std::vector<ContributorRun>& alone,
                                                         const BudgetRuns* budget = nullptr,
                                                         std::optional<double> coverage = {});

}  // namespace abbe
