// Recorded points in the place of nominal ones (`abbe run --recording`): whether they are those of this program.
#pragma once

#include "engine/run/run.hpp"
#include "programs/program_study.hpp"

namespace abbe {

/// What an error-free machine would record of the program: targets, normals, sensors. Throws UserError as record_plan does.
MachineRecord nominal_record(const CompiledProgram&, const Machine&);

/// Holds a recording in machine coordinates against the touches of the program. Throws UserError: rows of several runs or
/// placements (E0559), touches that only one of them has (E0544, E0560), other tips (E0545), and data problems as a
/// diagnosis finds them. Returns what it warns of. `file` names the recording in messages.
std::vector<Diagnostic> check_recorded_points(const Recording&, const CompiledProgram&, const Machine&,
                                              const std::string& file);

}  // namespace abbe
