// What was found, as the answer says it and as a machine file gets it.
#pragma once

#include <vector>

#include "engine/diagnose/findings/noise/noise_property.hpp"
#include "engine/diagnose/findings/search.hpp"

namespace abbe::diagnose {

/// Findings as effects of the answer and as settings of a machine file; `improvement` has been judged already.
void tell_findings(const Case&, const SearchResult&, Diagnosis&);
/// What no effect explains, and the pattern that a machine file may carry for it.
void tell_unexplained(const Case&, const SearchResult&, Diagnosis&);
/// Effects of the scatter, beside all that was told before.
void tell_noise(const Case&, std::vector<NoiseFinding>, Diagnosis&);
/// The verdict on all that was told.
Verdict verdict_of(const Case&, const SearchResult&, const Diagnosis&);

}  // namespace abbe::diagnose
