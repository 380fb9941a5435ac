// The sizes of what was found, with their uncertainty.
#pragma once

#include <optional>

#include "engine/diagnose/findings/search.hpp"

namespace abbe::diagnose {

struct FoundSize {
  std::vector<DiagnosedParameter> parameters;
  double largest_um = 0;  ///< DiagnosedEffect::largest_um
  RunChange change = {};  ///< of what has this size: of another member than the first it need not be that of the search
};
/// Of a finding's first member, or of another one in its place.
FoundSize estimate_size(const Case&, const SearchResult&, std::size_t finding, std::optional<int> member = {});

/// What of a variant changes between runs. Where it stands for a stretch of runs that holds the one of the finding, it is
/// that.
RunChange change_of(const Variant&, const Variant& found);

}  // namespace abbe::diagnose
