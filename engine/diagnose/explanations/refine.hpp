// Finer variants of effects where a recording asks for them.
#pragma once

#include "engine/diagnose/case.hpp"
#include "engine/diagnose/model/evidence.hpp"

namespace abbe::diagnose {

/// Finer variants of the effects that a recording speaks for: moments, periods and the like between those of
/// the grid. They are appended to the variants and take the place of the coarse ones in their explanations; the
/// search judges them too.
void refine(const Case&, Explanations&, EvidenceSearch&);

}  // namespace abbe::diagnose
