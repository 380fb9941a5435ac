// Handlers of sensors, motion, touches and fits.
#include <algorithm>
#include <set>
#include <utility>

#include "engine/features/fit.hpp"
#include "engine/features/nominal_normal.hpp"
#include "engine/features/pattern.hpp"
#include "engine/features/touched_fit.hpp"
#include "engine/lanes/random.hpp"
#include "engine/run/block_run.hpp"

namespace abbe {

void BlockRun::operator()(const plan::DefineFeature& define) {
  const plan::FeatureDef& def = executor.plan_[define.as.valid() ? define.as : define.feature];
  for_active([&](int i) -> std::string {
    Lane& lane = block.lanes[i];
    FeatureState& feature = state(lane, define.feature);
    feature.has_actual = false;
    feature.definition = define.as.valid() ? define.as : define.feature;
    feature.defined_in = lane.X_WD;
    feature.own_nominal = !def.varying.empty();
    if (def.varying.empty()) {
      if (block.is_twin(i)) feature.nominal = lane.X_WD * def.nominal;
      return "";
    }
    const Outcome<Element> nominal = def.kind->nominal(filled(lane, def.arguments, def.varying));
    if (!nominal) return nominal.failure;
    feature.nominal = lane.X_WD * nominal.value;
    return "";
  });
}

void BlockRun::operator()(const plan::SelectSensor& select) {
  constexpr std::uint32_t stream = stream_of("head");
  const Sensor& sensor = executor.sensors_[select.sensor.value];
  const HeadSpec& head = executor.machine_.head;
  for (const int i : active) {
    Lane& lane = block.lanes[i];
    lane.sensor = select.sensor;
    if (!sensor.indexed) continue;
    const bool stays =
        lane.head_indexed && lane.head_a_rad == sensor.head_a_rad && lane.head_b_rad == sensor.head_b_rad;
    if (stays) continue;
    if (lane.motion) lane.motion->index_head();
    lane.head_indexed = true;
    lane.head_a_rad = sensor.head_a_rad;
    lane.head_b_rad = sensor.head_b_rad;
    const UniformPair p =
        uniform_pair({executor.options_.noise_seed(), lane.machine_index, stream, 0, lane.indexings++, 0});
    if (block.is_twin(i) || !executor.options_.contributors.head) continue;
    lane.head_error_a_rad = head.sd_a_rad * normal_quantile(p.a);
    lane.head_error_b_rad = head.sd_b_rad * normal_quantile(p.b);
  }
}

void BlockRun::operator()(const plan::SetCompensation& set) {
  for (const int i : active) block.lanes[i].compensation = set.on;
}

void BlockRun::operator()(const plan::SetTemperatureCompensation& set) {
  for (const int i : active) block.lanes[i].temperature_compensation = set.on;
}

void BlockRun::operator()(const plan::SetMotion& set) {
  for (const int i : active)
    if (block.is_twin(i)) apply(block.lanes[i].motion->settings(), set, executor.machine_);
}

void BlockRun::go_to(int lane, const Vec3& point) {
  const Lane& twin = block.lanes[lane];
  block.lanes[lane].motion->move_to(point);
  if (!observed || lane != block.reference() || !twin.sensor.valid()) return;
  const Vec3 reading = point - executor.machine_.home_offset() - executor.sensors_[twin.sensor.value].tip_from_mount_mm;
  observed->stops.push_back({reading, operation, false, {}});
}

void BlockRun::operator()(const plan::Move& move) {
  for (const int i : active) {
    if (!block.is_twin(i)) continue;
    const Lane& lane = block.lanes[i];
    const Vec3 to = value(lane, move.to);
    go_to(i, move.relative ? lane.motion->position() + lane.X_WD.R * to : lane.X_WD * to);
  }
}

void BlockRun::operator()(const plan::SetHome& set) {
  for (const int i : active)
    if (block.is_twin(i)) block.lanes[i].home = block.lanes[i].X_WD * value(block.lanes[i], set.at);
}

void BlockRun::operator()(const plan::GoHome&) {
  for (const int i : active)
    if (block.is_twin(i) && block.lanes[i].home) go_to(i, *block.lanes[i].home);
}

void BlockRun::operator()(const plan::BeginMeasure& begin) {
  for_active([&](int i) -> std::string {
    Lane& lane = block.lanes[i];
    if (!state(lane, begin.feature).definition.valid())
      return "feature '" + executor.plan_[begin.feature].label + "' was not defined on the path that was taken";
    lane.points.clear();
    lane.targets.clear();
    return "";
  });
}

Outcome<Target> BlockRun::pattern_target(Lane& lane, const plan::Touch& touch) {
  const plan::FeatureDef& def = executor.plan_[touch.feature];
  const FeatureState& feature = state(lane, touch.feature);
  const Rigid& X_WD = feature.defined_in;
  const Element nominal =
      feature.own_nominal ? inverse(X_WD) * feature.nominal : executor.plan_[feature.definition].nominal;
  const auto made = pattern_touch(*def.kind, nominal, def.inner, touch.pattern_index, touch.pattern_count);
  if (!made) return Outcome<Target>::failed(made.failure);
  return {{X_WD * made.value.point + lane.X_WD.R * value(lane, touch.point), X_WD.R * made.value.normal}};
}

Outcome<BlockRun::Aim> BlockRun::aim(Lane& lane, Lane& twin, const plan::Touch& touch) {
  if (touch.pattern_count > 0) {
    const Outcome<Target> own = pattern_target(lane, touch), meant = pattern_target(twin, touch);
    return own ? Outcome<Aim>{{own.value, meant.value}} : Outcome<Aim>::failed(own.failure);
  }
  Aim a;
  a.meant.point = twin.X_WD * value(twin, touch.point);
  Vec3 normal_D;
  if (touch.has_normal) {
    normal_D = value(lane, touch.normal);
    if (norm(normal_D) == 0) return Outcome<Aim>::failed("the vector of the touch has no length");
    a.meant.normal = twin.X_WD.R * value(twin, touch.normal);
  } else {
    const plan::FeatureDef& def = executor.plan_[touch.feature];
    const Outcome<Vec3> n = nominal_normal(*def.kind, state(twin, touch.feature).nominal, def.inner, a.meant.point);
    if (!n) return Outcome<Aim>::failed(n.failure);
    a.meant.normal = n.value;
    normal_D = transpose(twin.X_WD.R) * n.value;
  }
  a.own = {lane.X_WD * value(lane, touch.point), lane.X_WD.R * unit(normal_D)};
  return {a};
}

bool BlockRun::prepare_touch(int slot, int index, const plan::Touch& touch) {
  Lane& lane = block.lanes[index];
  Lane& twin = twin_of(lane);
  if (!lane.sensor.valid()) return trap(index, "no sensor is selected (SNSLCT)"), false;
  const Sensor& sensor = executor.sensors_[lane.sensor.value];
  const Outcome<Aim> aimed = aim(lane, twin, touch);
  if (!aimed) return trap(index, aimed.failure), false;
  const auto& [point, normal] = aimed.value.own;
  Target meant{aimed.value.meant.point, unit(aimed.value.meant.normal)};
  const bool on_nominal_part = block.is_nominal(index);
  if (executor.options_.recorded && !on_nominal_part) {
    const auto recorded =
        executor.recorded_surface(touch.feature, twin.points.size(), meant.point, meant.normal, sensor.radius_mm);
    if (!recorded)
      return trap(index,
                  "the recording has no touch " + std::to_string(twin.points.size() + 1) + " of '" +
                      executor.plan_[touch.feature].label + "'"),
             false;
    meant.point = *recorded;
  }
  const Vec3 commanded = point + sensor.radius_mm * normal;
  touch_batch.commanded.set(slot, commanded);
  touch_batch.normal.set(slot, normal);
  touch_batch.surface.set(slot, meant.point);
  touch_batch.surface_normal.set(slot, meant.normal);
  targets[static_cast<std::size_t>(slot)] = meant;
  touch_batch.tip.set(slot, sensor.tip_from_mount_mm);
  touch_batch.reading.set(slot, commanded - executor.machine_.home_offset() - sensor.tip_from_mount_mm);
  touch_batch.error.set(slot,
                        lane.head_error_a_rad * sensor.per_rad_a_mm + lane.head_error_b_rad * sensor.per_rad_b_mm);
  touch_batch.radius[slot] = sensor.radius_mm;
  touch_batch.lane[slot] = index;
  touch_batch.machine[slot] = lane.machine_index;
  touch_batch.visit[slot] = visit(lane);
  R_WR[slot] = sensor.R_WR;
  if (executor.part_.given() && !on_nominal_part) put_on_part(touch, twin, slot);
  return true;
}

void BlockRun::add_errors(int machines) {
  const Contributors& act = executor.options_.contributors;
  TouchBatch& b = touch_batch;
  const int all = b.n;
  b.n = machines;  // the twins behind them stay free of errors
  if (act.geometry) {
    const auto in = [](const Columns3& c) {
      return std::array<const double*, 3>{c.column[0].data(), c.column[1].data(), c.column[2].data()};
    };
    const auto reading = in(b.reading), tip = in(b.tip);
    double* const error[3] = {b.error.column[0].data(), b.error.column[1].data(), b.error.column[2].data()};
    block.geometry.add_error(machines, b.lane.data(), reading.data(), tip.data(), error);
  }
  if (act.probe)
    add_probe_noise(b, executor.machine_.probe, executor.options_.noise_seed(), executor.site_[operation], R_WR);
  b.n = all;
}

void BlockRun::operator()(const plan::Touch& touch) {
  touch_batch.resize(static_cast<int>(active.size()));
  R_WR.resize(active.size());
  places.resize(active.size());
  targets.resize(active.size());
  int n = 0, machines = 0;
  for (const int lane : active) {
    if (!block.lanes[lane].running || !prepare_touch(n, lane, touch)) continue;
    ++n;
    if (!block.is_twin(lane)) ++machines;
  }
  touch_batch.n = n;
  add_errors(machines);
  move_twins(machines);
  if (executor.part_.given()) add_part(machines);
  add_effects(touch, machines);
  if (!executor.errors_act_on(touch.feature))
    for (int slot = 0; slot < machines; ++slot) touch_batch.error.set(slot, {});
  find_contact(touch_batch);
  block.touches += static_cast<std::uint64_t>(machines);
  for (int i = 0; i < n; ++i) {
    Lane& lane = block.lanes[touch_batch.lane[i]];
    const double offset = touch_batch.travel[i] - (lane.compensation ? touch_batch.radius[i] : 0.0);
    lane.points.push_back(touch_batch.commanded.get(i) + offset * touch_batch.normal.get(i));
    if (observed) observe_touch(touch, i);
    if (!block.is_twin(touch_batch.lane[i])) continue;
    // Without compensation the points reported are centres of the tip.
    Target target = targets[static_cast<std::size_t>(i)];
    if (!lane.compensation) target.point += touch_batch.radius[i] * target.normal;
    lane.targets.push_back(target);
  }
}

void BlockRun::fit_twins(plan::FeatureId feature, FitCriterion criterion) {
  const FeatureKind& kind = *executor.plan_[feature].kind;
  for_active([&](int i) -> std::string {
    Lane& lane = block.lanes[i];
    if (!block.is_twin(i)) return "";
    FeatureState& of = state(lane, feature);
    const Element& nominal = of.nominal;
    Element& result = of.actual;
    if (!kind.fit_points || kind.spread == 0) {
      const char* failure = nullptr;
      points_buffer.clear();
      for (const Vec3& p : lane.points) points_buffer.insert(points_buffer.end(), {p.x, p.y, p.z});
      kind.fit_lanes({points_buffer.data(), static_cast<int>(lane.points.size()), 1, 1}, &nominal, &result, &failure);
      if (failure) return failure;
    } else if (const Element* known = executor.known_fit(operation, lane.points)) {
      result = *known;
    } else {
      std::vector<Vec3> normals;
      for (const Target& t : lane.targets) normals.push_back(t.normal);
      FitSolution solution = fit_touched(kind.acts_as, lane.points, normals, nominal);
      if (solution.error) return solution.error->message;
      result = solution.element;
      // Fitted as the shape that it acts as: what it has besides is that of the nominal.
      if (kind.acts_as != kind.shape) result.angle = nominal.angle;
      result.second = nominal.second;
      if (const char* reason = refit(kind, criterion, lane.points, result)) return reason;
      if (observed) observed->fits.push_back({operation, lane.points, result});
    }
    of.has_actual = true;
    return "";
  });
}

void BlockRun::fit_machines(plan::FeatureId feature, FitCriterion criterion, std::size_t points) {
  std::vector<int> lanes;
  for (const int i : active)
    if (!block.is_twin(i) && block.lanes[i].running && block.lanes[i].points.size() == points) lanes.push_back(i);
  if (lanes.empty()) return;
  const int n = static_cast<int>(lanes.size());
  points_buffer.resize(3 * points * lanes.size());
  std::vector<Element> start(lanes.size()), result(lanes.size());
  std::vector<const char*> failure(lanes.size(), nullptr);
  for (int k = 0; k < n; ++k) {
    const Lane& lane = block.lanes[lanes[k]];
    Lane& twin = block.lanes[lane.twin];
    for (std::size_t p = 0; p < points; ++p)
      for (int axis = 0; axis < 3; ++axis) points_buffer[(3 * p + axis) * lanes.size() + k] = lane.points[p][axis];
    start[k] = (lane.X_WD * inverse(twin.X_WD)) * state(twin, feature).actual;
  }
  executor.plan_[feature].kind->fit_lanes({points_buffer.data(), static_cast<int>(points), n, n}, start.data(),
                                          result.data(), failure.data());
  for (int k = 0; k < n; ++k) {
    const FeatureKind& kind = *executor.plan_[feature].kind;
    if (kind.fit_points) result[k].second = start[k].second;
    if (!failure[k]) failure[k] = refit(kind, criterion, block.lanes[lanes[k]].points, result[k]);
    if (failure[k]) {
      trap(lanes[k], failure[k]);
      continue;
    }
    FeatureState& of = state(block.lanes[lanes[k]], feature);
    of.actual = result[k];
    of.has_actual = true;
  }
}

void BlockRun::keep_touches(plan::FeatureId feature) {
  if (!executor.keeps_touches_[feature.value]) return;
  for (const int i : active) {
    Lane& lane = block.lanes[i];
    FeatureState& of = state(lane, feature);
    of.touched = lane.points;
    if (block.is_nominal(i)) of.meant = lane.targets;
  }
}

void BlockRun::operator()(const plan::EndMeasure& end) {
  const FeatureKind& kind = *executor.plan_[end.feature].kind;
  for_active([&](int i) -> std::string {
    const int have = static_cast<int>(block.lanes[i].points.size());
    if (have >= kind.minimum_points) return "";
    return "a " + std::string(kind.word) + " needs at least " + std::to_string(kind.minimum_points) +
        " touches, this measurement has " + std::to_string(have);
  });
  keep_touches(end.feature);
  fit_twins(end.feature, end.criterion);
  if (observed) observe_measurement(end.feature);
  std::set<std::size_t> counts;  // lanes may have taken different paths inside the measurement
  for (const int i : active)
    if (block.lanes[i].running) counts.insert(block.lanes[i].points.size());
  for (const std::size_t count : counts) fit_machines(end.feature, end.criterion, count);
}

}  // namespace abbe
