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

namespace {

/// The horizontal axis nearest to the base: its guide lies on the table, or under it where it carries the part.
int axis_on_table(const Machine& machine) {
  for (const std::vector<Axis>* chain : {&machine.table_chain, &machine.ram_chain})
    for (const Axis axis : *chain)
      if (axis != Axis::z) return static_cast<int>(axis);
  return 0;
}

}  // namespace

void set_structure(const Machine& machine, TouchScene& scene) {
  for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
    const int k = static_cast<int>(axis);
    const AxisLever lever = axis_lever(machine, axis);
    scene.travel_length_mm[k] = machine[axis].travel_mm;
    scene.lever_mm[k] = lever.at(scene.reading, scene.stylus.tip_from_mount_mm);
    scene.side[k] = lever.sign;
  }
  scene.on_table = axis_on_table(machine);
  scene.on_bridge = 1 - scene.on_table;
}

}  // namespace abbe
