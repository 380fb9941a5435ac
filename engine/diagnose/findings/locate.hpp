// Where a mismatch lies, and what the catalogue does not explain of it.
#pragma once

#include "engine/diagnose/findings/search.hpp"

namespace abbe::diagnose {

/// The factor in which a variant of an explanation shows in this recording: the run where it is new in one, the setup where
/// it is there in one placement alone, else that of the explanation; or, where all touches are alike in that, what of
/// it they do differ in: the place, where it acts on that, else the direction.
Factor shown_in(const Case&, const Explanation&, const Variant&);
/// Of what the search has found; nothing without.
std::vector<Location> locate(const Case&, const EvidenceSearch& first, const SearchResult&);
/// A pattern of this size, um rms, that gains half this `energy` in log likelihood: the relative uncertainty of its amplitude
/// is one over its signal-to-noise, the root of the energy.
Unexplained pattern_of_size(Factor, std::string shape, double rms_um, double energy);
/// `predicts_as_well`: an effect that predicts the touches left out as well as the pattern does; "" when none does.
Unexplained describe_unexplained(const Case&, const SearchResult&, const std::string& predicts_as_well);

}  // namespace abbe::diagnose
