// A stylus system as the touch kernel needs it: where its tip is, and how the head's indexing errors move it.
#pragma once

#include <string_view>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/machine/machine.hpp"
#include "engine/plan/plan.hpp"

namespace abbe {

struct Sensor {
  std::string name;
  int ordinal = 1;         ///< 1, 2, ...: stylus systems in the order of their first use (stylus_ordinal)
  int tip_ordinal = 1;     ///< 1, 2, ...: qualified tips, which is each stylus system in each of its orientations
  Vec3 tip_in_r_mm;        ///< tip centre in the last link of the head
  Vec3 tip_from_mount_mm;  ///< nominal tip centre seen from the mounting point, along the axes of W
  Mat3 R_WR;               ///< the last link of the head in W: turns the probe's errors into W
  Vec3 per_rad_a_mm, per_rad_b_mm;  ///< displacement of the tip per radian of indexing error; zero for a fixed sensor
  double radius_mm = 0;
  bool indexed = false;
  double head_a_rad = 0, head_b_rad = 0;
  Vec3 to_head{0, 0, 1};  ///< unit vector from the tip towards the head, W
  double length_mm = 0;   ///< from the head's centre (or the mounting point) to the tip
  double shaft_diameter_mm = 0, young_MPa = 0, cte_per_K = 0;  ///< of the stylus: the machine file's, or a usual one
};

/// The ordinal of the stylus system of `sensor` after those of `before`: one stylus in several orientations
/// of the head is one system. So two sensors are of one system when tip, ball and shaft are the same in the
/// last link of the head.
int stylus_ordinal(const Sensor&, const std::vector<Sensor>& before);

/// Resolves a sensor of the program against the machine. Throws UserError when the machine file has no sensor
/// of that name.
Sensor resolve_sensor(const plan::SensorDef&, const Machine&, const SourceFile&);

}  // namespace abbe
