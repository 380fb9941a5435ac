// Raw readings hold the noise of their own touch.
#pragma once

#include "engine/diagnose/case.hpp"
#include "engine/diagnose/model/evidence.hpp"

namespace abbe::diagnose {

/// Takes the noise of each touch out of its raw readings, where there are any. `first`: the evidence of the
/// explanations so far, none of which looks at readings.
void free_readings_of_noise(Case&, const EvidenceSearch& first);

}  // namespace abbe::diagnose
