// What was found as all touches show it, those that were left out of the search too.
#pragma once

#include <optional>
#include <vector>

#include "engine/diagnose/findings/search.hpp"

namespace abbe::diagnose {

/// By finding, um per standard deviation.
std::vector<Matrix> on_all_touches(const Case&, const std::vector<Finding>&);

/// A length that is beyond the specification, without what was named as large as it is, and without gross outliers.
std::optional<LengthError> beyond_beside_names(const Case&, const SearchResult&);

}  // namespace abbe::diagnose
