// Readings of the scales that are not those of the touches: in another unit, of other axes, commanded, or none at all.
// From the scales to the tip is one vector for each stylus and orientation, but for what the controller corrects.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/recording/recording.hpp"

namespace abbe::diagnose {

/// Throws UserError (E0701): scale readings in another unit, or of other axes, than the positions.
void check_readings(const Recording&, const std::string& file);
enum class Places { positions, targets };
/// Whether scale readings go as far as these do from touch to touch, along one axis or as a whole. False without readings,
/// and along an axis of a part whose axes may not be the machine's.
bool readings_agree(const Recording&, Places, std::optional<int> axis = std::nullopt);
/// The coarsest step of which all readings of one scale, of touches along it, are multiples; 0 without readings.
double reading_step_mm(const Recording&);
/// Takes readings of the scales out that do not tell where in a signal period a touch was: constant, written coarsely, or of
/// something else (W0731). What is wrong with each touch would be all that they seem to hold.
void leave_out_readings_without_phase(Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// Takes readings of the scales out that follow the targets and not the touches (W0729): effects of the readings would
/// take each touch's own deviation from them.
void leave_out_commanded_readings(Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// Makes readings what they would be at the targets, in machine coordinates: by stylus and orientation as far beside them as in
/// the middle of all, to a millimetre.
void read_at_targets(Recording&);

}  // namespace abbe::diagnose
