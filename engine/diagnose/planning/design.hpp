// What a recording can tell, before anything is found.
#pragma once

#include "engine/diagnose/case.hpp"
#include "engine/diagnose/model/evidence.hpp"

namespace abbe::diagnose {

/// Of each effect of the catalogue that these touches can show: from which size on, in the unit of its parameter and as the
/// largest displacement in um, kPowerShare of recordings would be told as a mismatch, and from which on the effect would
/// be named; and which other effects look like it. Those that no size would show are left out.
std::vector<Detectable> smallest_detectable(const Case&, const EvidenceSearch&);

}  // namespace abbe::diagnose
