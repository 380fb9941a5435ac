#include "engine/report/report_words.hpp"

#include <array>

namespace abbe {

std::span<const ReportWord> report_words() {
  static constexpr std::array table = {
      ReportWord{"line", "line", "of the program, in which the characteristic is evaluated"},
      ReportWord{"feature", "feature", "labels of the features that the tolerance is evaluated of"},
      ReportWord{"tolerance", "tolerance", "label of the tolerance, and its kind"},
      ReportWord{"", "kind", "of the tolerance: DIAM, POS, ..."},
      ReportWord{"", "occurrence", "which of the evaluations of the same labels in the same line: a loop, a macro"},
      ReportWord{"unit", "unit", "of the figures: mm or deg"},
      ReportWord{"", "nominal", "what the drawing asks for"},
      ReportWord{"value", "reference", "what an error-free machine finds: here the value stands for the true one"},
      ReportWord{"", "mean", "average over the virtual machines (JCGM 101, 7.6)"},
      ReportWord{"u", "u", "standard uncertainty: standard deviation over the virtual machines (JCGM 101, 7.6)"},
      ReportWord{"U", "", "expanded uncertainty: half of the symmetric 95 % interval. Expectations call it u95"},
      ReportWord{"u95", "", "half of the symmetric 95 % interval: what is called U elsewhere"},
      ReportWord{"LCL", "lcl", "lower 95 % limit: the 2.5 % point over the virtual machines minus the value"},
      ReportWord{"UCL", "ucl", "upper 95 % limit: the 97.5 % point over the virtual machines minus the value"},
      ReportWord{"", "interval95",
                 "95 % interval of the values, probabilistically symmetric and shortest (JCGM 101, 7.7)"},
      ReportWord{"interval", "interval", "with --coverage: the same for another coverage probability"},
      ReportWord{"", "monte_carlo_error", "what the figures may err because machines are not endless"},
      ReportWord{"lower", "", "lower tolerance limit; '-' where there is none"},
      ReportWord{"upper", "", "upper tolerance limit; '-' where there is none"},
      ReportWord{"", "tolerance_limits", "lower and upper limit of the value, null where there is none"},
      ReportWord{"conforms", "conformance_probability",
                 "share of the virtual machines that find the value inside its tolerance"},
      ReportWord{"geometry", "", "share of the variance of the value that the machine's geometric errors have"},
      ReportWord{"head", "", "share of the variance that the indexing of the head has"},
      ReportWord{"probe", "", "share of the variance that the repeatability of the probe has"},
      ReportWord{"part", "", "share of the variance that the workpiece has: its calibration, temperature and form"},
      ReportWord{"", "contributions", "shares of the variance, each contributor acting alone; their sum is 1"},
      ReportWord{"source", "budget", "with --budget: every error function and every other source, acting alone"},
      ReportWord{"share", "share", "with --budget: of the variance of the value, by each source acting alone"},
      ReportWord{
          "alignment", "alignment_split",
          "with --budget: shares of the touches of features that coordinate systems are built from, and of others"},
      ReportWord{
          "accepted", "acceptance_limits",
          "the values that prove conformity: the tolerance limits less the guard band (ISO 14253-1). At the head of "
          "the report: the share of the machines drawn that satisfy the specification"},
      ReportWord{"", "guard_band",
                 "what a value must keep from the tolerance limits to prove conformity (ISO 14253-1)"},
      ReportWord{"verdict", "verdict", "conforms, undecided or does not conform, of the value (ISO 14253-1)"},
      ReportWord{"T/U", "tolerance_to_uncertainty",
                 "width of the tolerance over the expanded uncertainty U; a zone begins at 0"},
      ReportWord{"", "decision", "what the value proves, had it been measured: guard band, limits, verdict"},
      ReportWord{"", "rule", "the standard that decisions follow"},
      ReportWord{"", "probability", "from which on conformity counts as proven: 0.95"},
      ReportWord{"evaluated", "evaluated", "how many virtual machines evaluated it: all figures are theirs"},
      ReportWord{"trapped", "trapped", "how many virtual machines stopped before they evaluated it"},
      ReportWord{"lost", "lost", "characteristics that have no figures, and why"},
      ReportWord{"", "traps", "virtual machines that could not finish the program, and where they stopped"},
      ReportWord{"used", "used", "virtual machines that satisfy the specification and ran the program"},
      ReportWord{"generated", "generated",
                 "virtual machines that were drawn, those that fail the specification among them"},
      ReportWord{"", "failed_mpe", "virtual machines that were thrown away: errors too large for the specification"},
      ReportWord{"", "too_small", "virtual machines that were thrown away: errors too small for the specification"},
      ReportWord{"", "share_accepted", "share of the machines drawn that satisfy the specification"},
      ReportWord{"", "cycle_time_s", "estimated time of one run of the program on the machine"},
      ReportWord{"seed", "seed", "of the random numbers: the same one draws the same machines"},
      ReportWord{"effects", "effects_use",
                 "those of the machine file: left-in (an error of every result) or corrected (only their uncertainty)"},
      ReportWord{"", "errors_added_to", "nominal points, or with --recording the points of a recording"},
      ReportWord{"modelled", "influences",
                 "what acts on the result: modelled, bounded or not modelled (ISO/TS 15530-4)"},
      ReportWord{"bounded", "at_most_um", "an influence that is not propagated: what it may do at most"},
      ReportWord{"", "messages", "what was said of program, machine and result, with its code"},
  };
  return table;
}

}  // namespace abbe
