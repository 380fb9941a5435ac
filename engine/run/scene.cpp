// From the state of an error-free twin to the scene that the effects see, and the effects of a touch.
#include <map>

#include "engine/base/letter_case.hpp"
#include "engine/math/units.hpp"
#include "engine/run/block_run.hpp"
#include "engine/run/scene_terms.hpp"

namespace abbe {

namespace {

/// What stands in the columns of a recording that nobody logged stays empty.
void log_covariates(const Workpiece& w, RecordingRow& row) {
  const Temperatures t = w.temperatures(*row.time_s);
  const auto logged = [](bool known, double value) { return known ? std::optional(value) : std::nullopt; };
  row.temp_part_C = logged(w.knows.part, t.part);
  row.temp_x_C = logged(w.knows.scale[0], t.scale[0]);
  row.temp_y_C = logged(w.knows.scale[1], t.scale[1]);
  row.temp_z_C = logged(w.knows.scale[2], t.scale[2]);
  row.temp_air_C = logged(w.knows.air, t.air);
  row.load_kg = logged(w.knows.load, w.load_kg);
}

}  // namespace

void BlockRun::move_twins(int machines) {
  for (int slot = machines; slot < touch_batch.n; ++slot) {
    Lane& twin = block.lanes[touch_batch.lane[slot]];
    twin.last_touch = twin.motion->touch(touch_batch.commanded.get(slot), touch_batch.normal.get(slot));
  }
}

TouchScene BlockRun::scene_of(const plan::Touch& touch, int slot) const {
  const Lane& twin = block.lanes[touch_batch.lane[slot]];
  const TouchMotion& motion = twin.last_touch;
  TouchScene scene;
  scene.point = touch_batch.surface.get(slot);
  scene.normal = touch_batch.surface_normal.get(slot);
  scene.travel = motion.travel;
  scene.reading = touch_batch.reading.get(slot);
  scene.on_part = executor.X_PW_ * scene.point;
  scene.normal_on_part = executor.X_PW_.R * scene.normal;
  scene.stylus = stylus_scene(executor.sensors_[twin.sensor.value]);
  scene.time_s = motion.time_s;
  scene.speed_mm_s = motion.speed_mm_s;
  scene.acceleration_mm_s2 = motion.acceleration_mm_s2;
  scene.settled_s = motion.settled_s;
  std::copy(motion.sense, motion.sense + 3, scene.sense);
  std::copy(motion.since_reversal_mm, motion.since_reversal_mm + 3, scene.since_reversal_mm);
  if (executor.part_.given()) {
    scene.temperature = executor.part_.workpiece().temperatures(motion.time_s);
    scene.load_kg = executor.part_.workpiece().load_kg;
  }
  scene.touch = static_cast<int>(executor.site_[operation]);
  scene.feature = executor.measured_[touch.feature.value];
  scene.setup = executor.options_.setup;
  scene.curved = executor.curved_[touch.feature.value] != 0;
  scene.visit = static_cast<int>(twin.indexings);
  set_structure(executor.machine_, scene);
  return scene;
}

void BlockRun::add_effects(const plan::Touch& touch, int machines) {
  const EffectSet& effects = executor.effects_;
  if (!executor.options_.contributors.effects || effects.empty()) return;
  // The twins stand behind the machines in the batch; each makes the scene for the machines that share its path.
  std::map<int, EffectSet::Group> groups;
  for (int slot = 0; slot < machines; ++slot) {
    const Lane& lane = block.lanes[touch_batch.lane[slot]];
    EffectSet::Group& group = groups[lane.twin];
    group.slots.push_back(slot);
    group.indexings.push_back(lane.indexings);
  }
  const bool own_temperatures =
      executor.part_.given() && temperatures_vary(executor.part_.workpiece()) && effects.sees_temperatures();
  for (int slot = machines; slot < touch_batch.n; ++slot) {
    const auto group = groups.find(touch_batch.lane[slot]);
    if (group == groups.end()) continue;
    const TouchScene scene = scene_of(touch, slot);
    group->second.scene = &scene;
    group->second.seed = executor.options_.noise_seed();
    group->second.site = executor.site_[operation];
    if (own_temperatures) set_temperatures(scene.temperature, group->second);
    effects.add(executor.options_.contributors.only_effect, group->second, block.effects, touch_batch,
                block.activities);
  }
}

/// The true temperatures of each machine of a group: what effects depend on, and what nobody knows.
void BlockRun::set_temperatures(const Temperatures& estimate, EffectSet::Group& group) const {
  for (const int slot : group.slots)
    group.temperatures.push_back(drawn_temperatures(estimate, block.parts[touch_batch.lane[slot]].thermal));
}

void BlockRun::put_on_part(const plan::Touch& touch, Lane& twin, int slot) {
  const Mat3& R_WD = twin.X_WD.R;
  const Vec3 normal = touch_batch.surface_normal.get(slot);
  places[slot] = {touch.feature, touch_batch.surface.get(slot), normal, state(twin, touch.feature).nominal, R_WD.cx,
                  R_WD.cy};
  // Recorded points were made on the true part.
  if (executor.options_.recorded) return;
  touch_batch.surface.set(slot, places[slot].point + executor.part_.known_offset_mm(places[slot]) * normal);
}

void BlockRun::add_part(int machines) {
  const Part& part = executor.part_;
  for (int slot = machines; slot < touch_batch.n; ++slot) {
    const int index = touch_batch.lane[slot];
    Lane& twin = block.lanes[index];
    if (!twin.fixed_point) twin.fixed_point = touch_batch.surface.get(slot);
    if (!block.is_nominal(index) && part.has_random_form(places[slot].feature))
      twin.random_form = twin.spots.at(places[slot].point, places[slot].normal, executor.site_[operation]);
  }
  if (!executor.options_.contributors.part) return;
  for (int slot = 0; slot < machines; ++slot) {
    const Lane& lane = block.lanes[touch_batch.lane[slot]];
    const Lane& twin = twin_of(lane);
    const Temperatures estimate = part.workpiece().temperatures(twin.last_touch.time_s);
    const Vec3 d =
        part.error(block.parts[touch_batch.lane[slot]], places[slot], touch_batch.surface.get(slot) - *twin.fixed_point,
                   estimate, lane.temperature_compensation, twin.random_form);
    touch_batch.error.set(slot, touch_batch.error.get(slot) + d);
  }
}

void BlockRun::observe_touch(const plan::Touch& touch, int slot) {
  const int lane = touch_batch.lane[slot];
  if (lane == block.reference()) {
    const Rigid& X_WD = block.lanes[lane].X_WD;
    observed->stops.push_back(
        {touch_batch.reading.get(slot), operation, true, inverse(X_WD) * touch_batch.surface.get(slot)});
    observed->frames.add(X_WD, touch_batch.surface.get(slot));
    observed->curved.add(upper(executor.plan_[touch.feature].label), executor.options_.setup,
                         touch_batch.surface.get(slot), touch_batch.surface_normal.get(slot));
  }
  if (lane != 0 || block.machines == 0) return;
  observed->rows.push_back(recording_row(touch, slot));
  const Rigid X_MW{Mat3{}, -executor.options_.placement_mm};
  observed->aims.push_back({X_MW * block.lanes[block.lanes[lane].twin].X_WD, touch_batch.radius[slot]});
  const MotionSettings& motion = std::as_const(*block.lanes[block.lanes[lane].twin].motion).settings();
  observed->approaches_mm.insert(motion.approach_mm);
  observed->retracts_mm.insert(motion.retract_mm);
  observed->compensations.insert(block.lanes[lane].temperature_compensation);
}

void BlockRun::observe_measurement(plan::FeatureId feature) {
  for (const int i : active) {
    Lane& lane = block.lanes[i];
    if (!block.is_nominal(i) || !lane.running || !lane.sensor.valid()) continue;
    if (i != block.reference() && lane.twin != block.reference()) continue;
    const FeatureState& of = state(lane, feature);
    const double radius_mm = executor.sensors_[lane.sensor.value].radius_mm;
    observed->measured.push_back({operation, feature, of.nominal, of.actual, lane.targets, radius_mm});
  }
}

RecordingRow BlockRun::recording_row(const plan::Touch& touch, int slot) const {
  const Lane& lane = block.lanes[touch_batch.lane[slot]];
  const Lane& twin = block.lanes[lane.twin];
  const Sensor& sensor = executor.sensors_[lane.sensor.value];
  const Vec3 along = touch_batch.travel[slot] * touch_batch.normal.get(slot);
  const Vec3 true_normal = touch_batch.surface_normal.get(slot);
  RecordingRow row;
  row.feature = executor.plan_[touch.feature].label;
  row.touch = static_cast<int>(lane.points.size());
  row.setup = executor.options_.setup;
  row.run = executor.options_.repeat + 1;
  row.position_mm = touch_batch.commanded.get(slot) + along - executor.options_.placement_mm;
  row.target_mm = touch_batch.surface.get(slot) + sensor.radius_mm * true_normal - executor.options_.placement_mm;
  row.normal = true_normal;
  row.sensor = sensor.name;
  if (sensor.indexed) {
    row.head_a_deg = in_degrees(sensor.head_a_rad);
    row.head_b_deg = in_degrees(sensor.head_b_rad);
    row.visit = static_cast<int>(lane.indexings);
  }
  row.time_s = twin.last_touch.time_s;
  row.speed_mm_s = twin.last_touch.speed_mm_s;
  row.accel_mm_s2 = twin.last_touch.acceleration_mm_s2;
  row.travel = twin.last_touch.travel;
  row.reading_mm = touch_batch.reading.get(slot) + along;
  if (executor.part_.given()) log_covariates(executor.part_.workpiece(), row);
  return row;
}

}  // namespace abbe
