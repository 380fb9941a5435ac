#include "engine/run/executor.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "engine/base/letter_case.hpp"
#include "engine/run/alignment_features.hpp"
#include "engine/run/block_run.hpp"

namespace abbe {

std::uint64_t cost(const plan::Action& action) {
  using namespace plan;
  if (std::holds_alternative<Touch>(action)) return kTouchCost;
  const bool geometry = std::holds_alternative<EndMeasure>(action) || std::holds_alternative<Construct>(action) ||
      std::holds_alternative<SetDatumFrame>(action) || std::holds_alternative<Evaluate>(action);
  return geometry ? kCostOfGeometry : 1;
}

Executor::Executor(const plan::Plan& plan, const Machine& machine, const RunOptions& options, const SourceFile& source)
    : plan_(plan),
      machine_(machine),
      options_(options),
      effects_(machine.effects, options.effect_use, machine.name),
      part_(options.workpiece ? Part(*options.workpiece, plan) : Part()),
      aligns_(alignment_features(plan)),
      keeps_touches_(plan.features.size(), 0),
      slots_(feature_slots(plan)),
      visits_(visit_counters(plan)) {
  for (const plan::CharacteristicDef& c : plan.characteristics) {
    const plan::ToleranceDef& tolerance = plan[c.tolerance];
    if (!needs_touches(*tolerance.kind, tolerance.arguments)) continue;
    for (const plan::FeatureId f : c.features) keeps_touches_[f.value] = 1;
    for (const int f : tolerance.arguments.features("reference")) keeps_touches_[f] = 1;
  }
  for (auto op = plan.operations.rbegin(); op != plan.operations.rend(); ++op) {
    const auto* construct = std::get_if<plan::Construct>(&op->action);
    if (!construct || !construct->method->lies_between || !keeps_touches_[construct->result.value]) continue;
    for (const plan::FeatureId f : construct->from) keeps_touches_[f.value] = 1;
  }
  for (const plan::SensorDef& def : plan.sensors) {
    sensors_.push_back(resolve_sensor(def, machine, source));
    sensors_.back().ordinal = stylus_ordinal(sensors_.back(), {sensors_.begin(), sensors_.end() - 1});
    sensors_.back().tip_ordinal = static_cast<int>(sensors_.size());
  }
  if (options.recorded) find_recorded_points();
  std::uint32_t touches = 0;
  measured_.assign(plan.features.size(), -1);
  int features = 0;
  for (const plan::Operation& op : plan.operations) {
    const auto* touch = std::get_if<plan::Touch>(&op.action);
    site_.push_back(touch ? touches++ : 0);
    if (touch && measured_[touch->feature.value] < 0) measured_[touch->feature.value] = features++;
    cost_.push_back(cost(op.action));
    fuel_ += cost_.back();
  }
}

void Executor::find_curved(const CurvedFeatures& touched) {
  const std::set<std::string> curved = touched.curved();
  curved_.clear();
  for (const plan::FeatureDef& def : plan_.features) {
    const std::string key = upper(def.label);
    curved_.push_back(touched.touched(key) ? curved.count(key) > 0 : !def.kind->flat);
  }
}

void Executor::find_recorded_points() {
  std::multimap<std::string, int> features;
  for (std::size_t f = 0; f < plan_.features.size(); ++f)
    features.emplace(upper(plan_.features[f].label), static_cast<int>(f));
  for (const RecordingRow& row : options_.recorded->rows) {
    const auto [begin, end] = features.equal_range(upper(row.feature));
    for (auto feature = begin; feature != end; ++feature)
      recorded_.emplace(std::pair{feature->second, static_cast<std::size_t>(row.touch - 1)},
                        row.position_mm + options_.placement_mm);
  }
}

std::optional<Vec3> Executor::recorded_surface(plan::FeatureId feature, std::size_t touch, const Vec3& surface,
                                               const Vec3& normal, double radius_mm) const {
  const auto found = recorded_.find({feature.value, touch});
  if (found == recorded_.end()) return std::nullopt;
  const double beyond = options_.recorded->point == RecordedPoint::surface ? 0 : radius_mm;
  return surface + (dot(normal, found->second - surface) - beyond) * normal;
}

std::size_t Executor::lane_bytes() const {
  return sizeof(Lane) + slots_.count * sizeof(FeatureState) + visits_.count * sizeof(std::uint32_t) +
      plan_.frames.size() * sizeof(std::optional<Rigid>) + plan_.columns * sizeof(double) +
      plan_.characteristics.size() * sizeof(Value);
}

Block Executor::make_block(const VirtualMachines& machines, int first, int count) const {
  Lane start;
  start.X_WD = machine_frame();
  start.twin = count;
  start.temperature_compensation = part_.given() && part_.workpiece().compensated;
  start.features.resize(slots_.count);
  start.frames.resize(plan_.frames.size());
  start.columns.assign(plan_.columns, std::numeric_limits<double>::quiet_NaN());
  start.visits.assign(visits_.count, 0);

  const std::vector<std::uint32_t> index(machines.index.begin() + first, machines.index.begin() + first + count);
  const bool part_is_nominal = !part_.given() && !options_.recorded;
  const int nominal = part_is_nominal ? count : count + 1;
  Block block{std::vector<Lane>(nominal + 1, start),
              count,
              acting_geometry(machines, first, count),
              effects_.draw(options_.seed, index),
              effects_.none_active(),
              {},
              0};
  for (int i = 0; i < count; ++i) {
    block.lanes[i].machine_index = index[i];
    if (part_.given()) block.parts.push_back(part_.draw({options_.seed, index[i]}));
  }
  for (int i = count; i <= nominal; ++i) {
    block.lanes[i].twin = i;
    block.lanes[i].nominal = nominal;
    block.lanes[i].motion = Motion(machine_.home_offset() + options_.placement_mm, default_motion(machine_));
  }
  return block;
}

bool Executor::errors_act_on(plan::FeatureId feature) const {
  const ErroneousTouches touches = options_.contributors.touches;
  return touches == ErroneousTouches::all || (touches == ErroneousTouches::alignment) == (aligns_[feature.value] != 0);
}

GeometryBlock Executor::acting_geometry(const VirtualMachines& machines, int first, int count) const {
  std::vector<GeometryCoefficients> alone;
  std::vector<const GeometryCoefficients*> geometry;
  for (int i = 0; i < count; ++i) geometry.push_back(&machines.geometry[first + i]);
  if (const auto only = options_.contributors.only_component) {
    const std::size_t size = basis_size(machine_.harmonics), begin = size * static_cast<std::size_t>(*only);
    for (const GeometryCoefficients* all : geometry) {
      alone.emplace_back(all->size(), 0.0);
      std::copy_n(all->begin() + static_cast<std::ptrdiff_t>(begin), size,
                  alone.back().begin() + static_cast<std::ptrdiff_t>(begin));
    }
    for (int i = 0; i < count; ++i) geometry[i] = &alone[i];
  }
  return GeometryBlock(machine_, geometry);
}

void Executor::run(Block& block) const { BlockRun(*this, block).run(); }

void Executor::know(std::vector<KnownFit> fits) {
  for (KnownFit& fit : fits) known_fits_.emplace(fit.operation, std::move(fit));
}

const Element* Executor::known_fit(int operation, const std::vector<Vec3>& points) const {
  const auto [first, last] = known_fits_.equal_range(operation);
  for (auto it = first; it != last; ++it)
    if (it->second.points == points) return &it->second.element;
  return nullptr;
}

Executor::Observed Executor::observe(Block& block) const {
  Observed observed;
  BlockRun(*this, block, &observed).run();
  return observed;
}

void BlockRun::run() {
  while (gather_lowest(), !active.empty()) {
    for (const int lane : active) {
      ++block.lanes[lane].pc;
      if ((block.lanes[lane].fuel_used += executor.cost_[static_cast<std::size_t>(operation)]) > executor.fuel_)
        trap(lane, "the program does not end: two million operations were run (endless loop)");
    }
    std::erase_if(active, [&](int lane) { return !block.lanes[lane].running; });
    std::visit(*this, executor.plan_.operations[operation].action);
  }
}

void BlockRun::gather_lowest() {
  const int end = static_cast<int>(executor.plan_.operations.size());
  int lowest = end;
  for (const Lane& lane : block.lanes)
    if (lane.running) lowest = std::min(lowest, lane.pc);
  active.clear();
  operation = lowest;
  if (lowest == end) return;
  for (int i = 0; i < static_cast<int>(block.lanes.size()); ++i)
    if (block.lanes[i].running && block.lanes[i].pc == lowest) active.push_back(i);
}

void BlockRun::trap(int index, std::string reason) {
  Lane& lane = block.lanes[index];
  if (!lane.running) return;
  lane.running = false;
  lane.trap = {operation, std::move(reason)};
  if (!block.is_twin(index)) return;
  // Without an error-free machine on its path a virtual machine does not know where the part is, without a
  // nominal lane a twin does not know where it was meant to be. A nominal lane without its twin has no path.
  const auto depends = [&](int i) {
    return block.is_twin(i) ? block.lanes[i].nominal == index : block.lanes[i].twin == index;
  };
  const std::string why = block.lanes[index].trap.reason;
  for (int i = 0; i < static_cast<int>(block.lanes.size()); ++i)
    if (i != index && depends(i)) trap(i, why);
  block.lanes[block.lanes[index].nominal].running = false;
}

double BlockRun::value(const Lane& lane, const plan::Operand& operand) const {
  return operand.column.valid() ? lane.columns[operand.column.value] : operand.constant;
}

Vec3 BlockRun::value(const Lane& lane, const plan::Point& point) const {
  return {value(lane, point[0]), value(lane, point[1]), value(lane, point[2])};
}

void BlockRun::for_active(const std::function<std::string(int)>& f) {
  for (const int lane : active) {
    if (!block.lanes[lane].running) continue;
    if (std::string reason = f(lane); !reason.empty()) trap(lane, std::move(reason));
  }
}

FeatureState& BlockRun::state(Lane& lane, plan::FeatureId feature) {
  const int slot = executor.slots_.slot[feature.value];
  ABBE_CHECK(slot >= 0);
  FeatureState& state = lane.features[slot];
  if (state.feature != feature) {  // what is left there of a feature that no operation names any more
    state = {};
    state.feature = feature;
  }
  return state;
}

int BlockRun::visit(Lane& lane) {
  const int counter = executor.visits_.counter[operation];
  return counter < 0 ? 0 : static_cast<int>(lane.visits[counter]++);
}

const Element* BlockRun::actual(int lane, plan::FeatureId feature) {
  const FeatureState& of = state(block.lanes[lane], feature);
  if (of.has_actual) return &of.actual;
  trap(lane, "feature '" + executor.plan_[feature].label + "' has not been measured or constructed at this point");
  return nullptr;
}

}  // namespace abbe
