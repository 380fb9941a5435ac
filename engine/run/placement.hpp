// Where the program's machine coordinate system lies in the machine.
//
// A program written on another machine has the coordinates of that machine: where its home is and which tip
// set the zero differ, above all in height, because the table's height in machine coordinates depends on the
// length of the tip that was zeroed. So when a program reaches outside the travel in z, and its touches have room
// there, Abbe shifts it so that they stand in the middle of the z travel, by no more than twice the travel, and
// says so. In x and y nothing is guessed: there a touch outside the travel is an error.
#pragma once

#include <optional>

#include "engine/run/run.hpp"

namespace abbe {

struct Placement {
  Vec3 shift_mm;
  std::optional<Diagnostic> message;  ///< the warning that names the shift
};

/// The placement for a program that gives none itself. Where the error-free machine stops, that of the touches before:
/// run_plan then says what stops it. Throws UserError for a sensor or an effect that cannot be, as run_plan does.
Placement find_placement(const plan::Plan&, const Machine&, const SourceFile&);

}  // namespace abbe
