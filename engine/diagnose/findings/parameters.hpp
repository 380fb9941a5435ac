// The sizes of what was found, with their uncertainty.
#pragma once

#include <optional>

#include "engine/diagnose/findings/search.hpp"

namespace abbe::diagnose {

struct FoundSize {
  std::vector<DiagnosedParameter> parameters;
  double largest_um = 0;  ///< DiagnosedEffect::largest_um
};
/// Of a finding's first member, or of another one in its place.
FoundSize estimate_size(const Case&, const SearchResult&, std::size_t finding, std::optional<int> member = {});

}  // namespace abbe::diagnose
