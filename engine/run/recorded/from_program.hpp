// What a recording leaves out and its program knows.
#pragma once

#include <string>

#include "engine/recording/recording.hpp"
#include "engine/run/run.hpp"

namespace abbe {

/// Whether a program has said of every row where on the part it lies.
bool lies_as_planned(const Recording&);

/// Fills what rows lack (target, normal, sensor, times, ...) from what an error-free machine makes of their
/// program, pairing rows by feature and touch. Targets are of the point that the recording states. Part
/// coordinates, those of the program at each touch, become machine coordinates: the program says where the
/// part stands. Throws UserError when rows have no partner and need one: which, and what the program has.
void complete_from_program(Recording&, const MachineRecord& nominal, const std::string& file);

}  // namespace abbe
