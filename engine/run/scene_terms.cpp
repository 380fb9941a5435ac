#include "engine/run/scene_terms.hpp"
#include "engine/machine/geometry.hpp"

namespace abbe {

StylusScene stylus_scene(const Sensor& sensor) {
  StylusScene s;
  s.name = sensor.name;
  s.tip_from_mount_mm = sensor.tip_from_mount_mm;
  s.to_head = sensor.to_head;
  s.R_WR = sensor.R_WR;
  s.length_mm = sensor.length_mm;
  s.radius_mm = sensor.radius_mm;
  s.shaft_diameter_mm = sensor.shaft_diameter_mm;
  s.young_MPa = sensor.young_MPa;
  s.cte_per_K = sensor.cte_per_K;
  s.head_a_rad = sensor.head_a_rad;
  s.head_b_rad = sensor.head_b_rad;
  s.indexed = sensor.indexed;
  s.ordinal = sensor.ordinal;
  s.tip_ordinal = sensor.tip_ordinal;
  return s;
}

void set_structure(const Machine& machine, TouchScene& scene) {
  for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
    const int k = static_cast<int>(axis);
    const AxisLever lever = axis_lever(machine, axis);
    scene.travel_length_mm[k] = machine[axis].travel_mm;
    scene.lever_mm[k] = lever.at(scene.reading, scene.stylus.tip_from_mount_mm);
    scene.side[k] = lever.sign;
  }
  // A table that moves along y has its guide under it, and leaves the bridge to x.
  if (machine[Axis::y].table_side && !machine[Axis::x].table_side) scene.on_table = 1, scene.on_bridge = 0;
}

}  // namespace abbe
