// What a recording can tell, before anything is found.
#pragma once

#include "engine/diagnose/case.hpp"
#include "engine/diagnose/model/evidence.hpp"

namespace abbe::diagnose {

std::vector<Detectable> smallest_detectable(const Case&, const EvidenceSearch&);

}  // namespace abbe::diagnose
