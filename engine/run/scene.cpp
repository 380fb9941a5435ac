// From the state of an error-free twin to the scene that the effects see, and the effects of a touch.
#include <map>

#include "engine/run/block_run.hpp"

namespace abbe {

namespace {

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
  return s;
}

}  // namespace

void BlockRun::add_effects(const plan::Touch& touch, int machines) {
  // The twins stand behind the machines in the batch; each moves, and makes the scene for the machines that share its path.
  std::map<int, EffectSet::Group> groups;
  for (int slot = 0; slot < machines; ++slot) {
    const Lane& lane = block.lanes[touch_batch.lane[slot]];
    EffectSet::Group& group = groups[lane.twin];
    group.slots.push_back(slot);
    group.indexings.push_back(lane.indexings);
  }
  const bool acting = executor.options_.contributors.effects && !executor.effects_.empty();
  for (int slot = machines; slot < touch_batch.n; ++slot) {
    const int index = touch_batch.lane[slot];
    Lane& twin = block.lanes[index];
    const TouchMotion motion = twin.motion->touch(touch_batch.commanded.get(slot), touch_batch.normal.get(slot));
    const auto group = groups.find(index);
    if (!acting || group == groups.end()) continue;
    TouchScene scene;
    scene.point = touch_batch.surface.get(slot);
    scene.normal = touch_batch.surface_normal.get(slot);
    scene.travel = motion.travel;
    scene.reading = touch_batch.reading.get(slot);
    scene.on_part = inverse(twin.X_WD) * scene.point;
    scene.normal_on_part = transpose(twin.X_WD.R) * scene.normal;
    scene.stylus = stylus_scene(executor.sensors_[twin.sensor.value]);
    scene.time_s = motion.time_s;
    scene.speed_mm_s = motion.speed_mm_s;
    scene.acceleration_mm_s2 = motion.acceleration_mm_s2;
    scene.settled_s = motion.settled_s;
    std::copy(motion.sense, motion.sense + 3, scene.sense);
    std::copy(motion.since_reversal_mm, motion.since_reversal_mm + 3, scene.since_reversal_mm);
    scene.touch = static_cast<int>(executor.site_[operation]);
    scene.feature = touch.feature.value;
    scene.visit = static_cast<int>(twin.indexings);
    for (int axis = 0; axis < 3; ++axis) scene.travel_length_mm[axis] = executor.machine_.axes[axis].travel_mm;
    group->second.scene = &scene;
    executor.effects_.add(executor.options_.contributors.only_effect.value_or(-1), group->second, block.effects, executor.options_.seed,
                          executor.site_[operation], touch_batch);
  }
}

}  // namespace abbe
