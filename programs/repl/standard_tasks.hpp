// What a stylus system is worth, before a program is written for it: where its tip is, how long the
// Abbe levers are, and what uncertainty a few standard tasks get with it.
//
// The lever of an axis is the distance, across that axis, from its scale to the tip: the rotations
// of the carriage act on it (Abbe principle; paper eq. 17 and Table 2). The tasks stand at one
// place in the middle of the machine, the same for all candidates: a length of two opposed touches
// along each axis, and a sphere of 30 mm with the 25 points of ISO 10360-5.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/machine/machine.hpp"
#include "programs/program_study.hpp"

namespace abbe {

struct TaskUncertainties {
  std::array<double, 3> length_mm{};  ///< u95 of a length along X, Y, Z
  double size_mm = 0, form_mm = 0;    ///< u95 of the sphere's diameter; upper 95 % limit of its form
};

struct SensorFigures {
  std::string label;
  Vec3 tip_from_mount_mm;
  std::array<double, 3> lever_mm{};        ///< by Axis, at the middle of the travels
  std::optional<TaskUncertainties> tasks;  ///< none when the tip does not reach the place
};

/// The figures of each candidate, on the machines that `settings` asks for. `source` is what the
/// candidates were read from. Throws UserError as read_machine does, and for a sensor that the
/// machine file lacks.
std::vector<SensorFigures> sensor_figures(const std::vector<plan::SensorDef>& candidates, const Machine&,
                                          const SourceFile& source, const StudySettings& settings);

/// The figures side by side, one line for each sensor.
std::string sensor_table(const std::vector<SensorFigures>&);

/// Length of the standard lengths on this machine, mm.
double standard_length_mm(const Machine&);

}  // namespace abbe
