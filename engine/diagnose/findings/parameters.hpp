// The sizes of what was found, with their uncertainty.
#pragma once

#include "engine/diagnose/findings/search.hpp"

namespace abbe::diagnose {

struct FoundSize {
  std::vector<DiagnosedParameter> parameters;
  double largest_um = 0;  ///< DiagnosedEffect::largest_um
};
FoundSize estimate_size(const Case&, const SearchResult&, std::size_t finding);

}  // namespace abbe::diagnose
