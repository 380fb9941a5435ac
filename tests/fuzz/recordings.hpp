// What every recording must survive, whole or damaged: that it is read, and its touches made scenes of the machine.
#pragma once

#include <random>

namespace abbe::fuzz {

/// Damages a recording of touches, one of values and a result file of DMIS, and reads what is left of each. Whatever
/// cannot be read is refused with a message. How many could be read.
int exercise_recordings(std::mt19937&);

}  // namespace abbe::fuzz
