// Stylus systems in recordings. A recording names its sensors; what they are stands in the machine file, or,
// when the program defined them (SNSDEF), in `# sensor NAME: ...` lines of the recording, so that it can be
// diagnosed without the program.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/machine/machine.hpp"
#include "engine/recording/recording.hpp"
#include "engine/run/sensor.hpp"

namespace abbe {

/// The metadata line of a sensor: key and value, "head_deg A B tip_in_r_mm x y z diameter_mm d ..." in the
/// words of the machine file.
std::pair<std::string, std::string> sensor_line(const Sensor&, const Machine&);

/// Gives a machine the sensors that a recording describes. Of one name the recording's counts, which says
/// what was mounted then; a note says where the machine file has another. Of two descriptions of one stylus, qualified
/// twice, the first counts. Throws UserError for a line that cannot be read and for one name of two styli (E0707).
void add_recorded_sensors(const Recording&, Machine&, const std::string& file, std::vector<Diagnostic>& messages);

}  // namespace abbe
