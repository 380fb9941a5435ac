// The result file of a machine in the form of ISO 22093: what each OUTPUT statement reports, features as FA, tolerances as TA.
//
// Coordinates are in the system current at the OUTPUT statement, lengths mm, angles decimal degrees, whatever the program's own units.
// TA of a tolerance with one value is `word[,qualifier],value,INTOL|OUTOL`; distances put the status before NOMINL, as real result
// files do (DISTB, DISTWRT).
#pragma once

#include <string>
#include <vector>

#include "engine/run/run.hpp"

namespace abbe {

std::string dmis_result(const plan::Plan&, const std::vector<OutputRecord>&);

}  // namespace abbe
