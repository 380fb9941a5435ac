// The uncertainty budget of one characteristic: which source, and which touches, its variance comes
// from.
//
// Sources are taken one at a time: the variance of the run in which only that one acts, over the
// sum of these variances. Touches are taken together with their correlations: with y = y_a + y_f,
// the deviations that errors of the alignment's touches and of the others cause by themselves,
// var(y) = cov(y_a, y) + cov(y_f, y), so cov(y_a, y)/var(y) is the share of the alignment. It may be
// negative, or above 1, where the two compensate each other. What the sum leaves open is the
// interaction of the two: zero as long as the characteristic is linear in the errors.
#pragma once

#include "engine/report/report_unit.hpp"
#include "engine/report/run_report.hpp"

namespace abbe {

/// A standard deviation below this, mm or rad, counts as none: 1 nm, which no coordinate measuring machine resolves, or
/// the angle of 1 nm over a metre. What is smaller is rounding, or what products of errors leave of a quantity that no
/// touch shows: the point of a bore, 5 um off its place and carried along an axis that leans by 40 um/m, moves by 0.2 nm.
constexpr double smallest_u(Unit unit) { return unit == Unit::mm ? 1e-6 : 1e-9; }

/// An interaction below this share is left out.
inline constexpr double kSmallestInteraction = 0.01;

/// Of entry `index` of the samples of the run with all sources; `factor` turns its unit into that of
/// the report. Empty when a source's own run left too few values to tell. Variances below that of
/// smallest_u count as 0.
std::vector<CharacteristicReport::BudgetLine> variance_budget(const std::vector<ContributorRun>& alone,
                                                              const std::vector<Samples>& samples, std::size_t index,
                                                              Unit unit, double factor);

/// "alignment", "feature" and, when it is not small, "interaction", from the machines that reached
/// the characteristic in all three runs. Empty when fewer than two did.
std::vector<CharacteristicReport::BudgetLine> alignment_split(const Samples& all, const Samples& alignment,
                                                              const Samples& feature, Unit unit, double factor);

}  // namespace abbe
