// What the findings improve, on touches that they were not fitted to.
#pragma once

#include "engine/diagnose/findings/search.hpp"

namespace abbe::diagnose {

/// Standard error of the sum of what groups of rows gain, of which the larger ones gain more: the ratio estimator of gain
/// per row (Cochran 1977, 6.3). `gain`: by group, in ascending order of their numbers; `group`: by row.
double standard_error_of_sum(const std::vector<double>& gain, const std::vector<int>& group);

void show_improvement(const Case&, const SearchResult&, Diagnosis&);

}  // namespace abbe::diagnose
