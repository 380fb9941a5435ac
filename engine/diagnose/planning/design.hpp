// What a recording can tell, before anything is found; and what simpler methods say of it.
#pragma once

#include "engine/diagnose/case.hpp"
#include "engine/diagnose/model/evidence.hpp"

namespace abbe::diagnose {

std::vector<Detectable> smallest_detectable(const Case&, const EvidenceSearch&);
Rivals rivals(const Case&, const Evidence& first);

}  // namespace abbe::diagnose
