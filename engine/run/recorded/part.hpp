// What a workpiece file says of the part that a recording was made on: a calibration certificate and a
// thermometer for the diagnosis.
//
// Targets are nominal unless the recording says `# workpiece: NAME` of the file given: then they are already
// those of the true part. A surface that the file describes is known with the uncertainty stated there; its
// best estimate moves the target. A diameter needs the nominal one, and a recording does not state it, but
// its targets do: on every round surface p = c + R n + t a with n perpendicular to the axis a, so R = sum (p
// - p')(n - n') / sum |n - n'|^2, means primed; R is negative for a bore. Temperatures and expansion
// coefficients stretch the recorded part as they stretch a simulated one (workpiece.hpp, strain); where it is
// held does not matter, because the placement is free.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/run/recorded/touch.hpp"
#include "engine/workpiece/workpiece.hpp"

namespace abbe {

struct RecordedPart {
  std::vector<double> expected_mm;  ///< by touch: the residual on an error-free machine, best estimate
  /// each by touch: the residual that one standard deviation of one unknown makes
  std::vector<std::vector<double>> doubt_mm;
  std::vector<char> calibrated;  ///< by RecordedTouches::features: its place is known, within `doubt_mm`
  std::vector<Diagnostic> messages;
};

/// The nominal radius of a round feature from the targets of its touches, negative for a bore; nothing when
/// the feature is not round. `form_mm`: by how much its surface may lie off the round one.
std::optional<double> round_radius(const RecordedTouches&, const std::vector<int>& touches, double form_mm = 0);

/// Temperatures and load of the workpiece file in rows that have none.
void fill_from_workpiece(Recording&, const Workpiece&);

/// Throws UserError: a surface that the recording does not have, a diameter of a feature that is not round,
/// targets of another part.
RecordedPart recorded_part(const Workpiece&, const Recording&, const RecordedTouches&, const std::string& file);

}  // namespace abbe
