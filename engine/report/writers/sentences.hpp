// What the reports for people say, in words and to how many digits: text and page say the same.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/report/run_report.hpp"

namespace abbe {

/// mm and degrees keep at least so many decimals, and have no more than so many.
inline constexpr int kFewestDecimals = 4, kMostDecimals = 9;

/// The figure, but nothing where no influence changes the value: what is not known is not 0.
std::optional<double> known(const CharacteristicReport&, std::optional<double> figure);

/// Decimals that show two significant digits of u. Below 1 pm it is the rounding of coordinates.
int decimals_for(double u);
/// Those of the figures of one characteristic: the fewest where its u is not known.
int decimals_for(const CharacteristicReport&);

/// Decimals that show a tolerance limit to 1 pm, as the program states it.
int decimals_of(std::optional<double> limit);

/// "12.340", or with its sign "+12.340"; "-" where there is none, and no "-0.0000".
std::string decimal(std::optional<double> value, int decimals, bool sign = false);

/// "SIZE (DIAM)", of a further evaluation "SIZE (DIAM) #2".
std::string tolerance_name(const CharacteristicReport&);

/// "-0.0012 to +0.0034": the ends of an interval of values, minus the reference; "-" where there is none, or u is not known.
std::string from_reference(const CharacteristicReport&, const Interval&);

/// The share of the k-th contributor: "62 %"; "-" where it is not known.
std::string share_of(const CharacteristicReport&, std::size_t k);

/// What a budget shows: the sources, the largest first, without those below a thousandth of the variance;
/// then alignment and feature. Nothing where u is not known.
std::vector<CharacteristicReport::BudgetLine> budget_lines(const CharacteristicReport&);

/// Share of conforming machines: "99.8 %"; and of how many, where a condition sent some past it.
std::string conforms(const CharacteristicReport&);

/// The values that prove conformity: "9.9952 to 10.0048", of a zone "up to 0.0039", "none".
std::string accepted(const CharacteristicReport&, const CharacteristicReport::Decision&);

/// Tolerance over expanded uncertainty: "12.3".
std::string tolerance_to_uncertainty(const CharacteristicReport::Decision&);

/// Words with commas between them.
std::string joined(const std::vector<std::string>& words);

/// From the first characteristic that knows its shares.
std::vector<std::string> contributor_names(const RunReport&);

// Lines that end with a newline, or nothing.

/// What was run, on what.
std::string report_header(const RunReport&);
/// What the columns of the table are.
std::string report_legend(const RunReport&);
/// What the columns of the decisions are; no newline at the end.
std::string decision_legend();
/// What the lines of a budget are; no newline at the end.
std::string budget_legend();
/// Machines that stopped, characteristics that were lost.
std::string report_remarks(const RunReport&);
/// What is in no figure of the report.
std::string report_bounds(const RunReport&);

}  // namespace abbe
