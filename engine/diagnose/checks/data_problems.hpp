// What is wrong with a file, and no physics: found before anything is judged.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/diagnose/diagnosis.hpp"
#include "engine/run/recorded/touch.hpp"

namespace abbe::diagnose {

/// A recording without its exact copies of rows. Throws UserError: one touch with two values.
Recording without_copies(const Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// A recording whose clock of the day falls back at midnight, with times that go on (N0727): what comes later in the file
/// stands more than half a day before what comes first.
void continue_past_midnight(Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// A recording whose clock began long before its first touch, with times from that touch on (N0721).
void count_from_first_touch(Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// A recording without what was logged in some rows only: what is missing would be taken for its usual value, beside
/// what was logged (W0722).
void leave_out_partly_logged(Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// Warns of temperatures that no measuring room has (W0724).
void doubt_temperatures(const Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// Warns of speeds, accelerations and clocks that no machine has (W0728).
void doubt_motion(const Recording&, const std::string& file, std::vector<Diagnostic>& messages);

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
/// Whether more than one stylus or orientation must have touched, and no row says which (W0725).
bool styli_unlogged(const Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// Takes directions of travel out that are the same in all rows, where no one direction touches all surfaces (W0732).
void leave_out_constant_travel(Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// Of the directions in space, about 15 degrees apart, the best: how far along it all normals point at least, from -1 to 1.
double least_along_the_best(const std::vector<Vec3>& normals);
/// Throws UserError where the normals of balls do not stand on them, but would with other axes or another sign.
void check_normals_of_balls(const Recording&, const std::string& file);
/// Normals that point into a ball: throws UserError (E0701) where the stylus would come through the material, else notes
/// it (N0733).
void doubt_hollow_balls(const Recording&, const RecordedTouches&, const std::string& file,
                        std::vector<Diagnostic>& messages);
/// Throws UserError where the machine does not travel against the normals that it touches; `back` turns a setup onto
/// its targets.
void check_normals(const std::vector<const RecordingRow*>& setup, const Mat3& back, const std::string& file);
/// Throws UserError: another unit or other axes.
void check_data(const Recording&, const Machine&, const std::string& file);
/// Throws UserError (E0701) when all touches of one feature lie a tip's radius or diameter too far out or in.
void check_tips(const RecordedTouches&, const std::string& file);
/// Takes rows out that lie so far from their targets that they are no touches of these (W0712). Throws UserError (E0711) when
/// they are many.
void leave_out_astray(Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// Throws UserError when many touches lie beside their targets; a few are warned of.
void check_pairing(const Recording&, const RecordedTouches&, const std::string& file,
                   std::vector<Diagnostic>& messages);

}  // namespace abbe::diagnose
