// What the reports for people say in words, and to how many digits: text and page say the same. Each function returns lines that end with a
// newline, or nothing.
#pragma once

#include <string>
#include <vector>

#include "engine/report/run_report.hpp"

namespace abbe {

/// mm and degrees keep at least so many decimals, and have no more than so many.
inline constexpr int kFewestDecimals = 4, kMostDecimals = 9;

/// A budget leaves out sources with less than this share of the variance.
inline constexpr double kSmallestShare = 0.001;

/// Decimals that show two significant digits of u. Below 1 pm it is the rounding of coordinates.
int decimals_for(double u);

/// Share of conforming machines: "99.8 %"; and of how many, where a condition sent some past it.
std::string conforms(const CharacteristicReport&);

/// Words with commas between them.
std::string joined(const std::vector<std::string>& words);

/// From the first characteristic that knows its shares.
std::vector<std::string> contributor_names(const RunReport&);

/// What was run, on what.
std::string report_header(const RunReport&);
/// What the columns of the table are.
std::string report_legend(const RunReport&);
/// What the lines of a budget are; no newline at the end.
std::string budget_legend();
/// Machines that stopped, characteristics that were lost, messages without a place in a file; those with one are shown when the program is
/// read.
std::string report_remarks(const RunReport&);
/// What is in no figure of the report.
std::string report_bounds(const RunReport&);

}  // namespace abbe
