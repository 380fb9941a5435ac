// Normals, and directions of travel, that contradict the targets or each other: of other axes, the wrong way, or one value
// for all rows.
#pragma once

#include <string>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/math/vec.hpp"
#include "engine/recording/recording.hpp"
#include "engine/run/recorded/touch.hpp"

namespace abbe::diagnose {

/// Throws UserError where the normals of balls do not stand on them, but would with other axes or another sign.
void check_normals_of_balls(const Recording&, const std::string& file);
/// Normals that point into a ball: throws UserError (E0701) where the stylus would come through the material, else notes
/// it (N0733).
void doubt_hollow_balls(const Recording&, const RecordedTouches&, const std::string& file,
                        std::vector<Diagnostic>& messages);
/// Throws UserError where the machine does not travel against the normals that it touches; `back` turns a setup onto
/// its targets.
void check_normals(const std::vector<const RecordingRow*>& setup, const Mat3& back, const std::string& file);
/// Takes directions of travel out that are the same in all rows, where no one direction touches all surfaces (W0732).
void leave_out_constant_travel(Recording&, const std::string& file, std::vector<Diagnostic>& messages);

}  // namespace abbe::diagnose
