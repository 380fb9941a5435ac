#include "engine/run/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "engine/base/on_threads.hpp"
#include "engine/run/executor.hpp"
#include "engine/run/recorded/sensor_lines.hpp"
#include "engine/run/reference_run.hpp"

namespace abbe {

namespace {

using Key = std::pair<int, int>;  // characteristic, visit

/// What one block contributes; merged in block order, so that the result does not depend on threads. All
/// blocks are kept until then, so of every value only what differs from machine to machine.
struct BlockResult {
  struct Kept {
    plan::CharacteristicId characteristic;
    int visit = 0;
    double value = 0;
    Key key() const { return {characteristic.value, visit}; }
  };
  struct LaneResult {
    std::vector<Kept> values;
    std::vector<ToleranceLimits> own_limits;  ///< in the same order, of characteristics that have them
    std::optional<LaneTrap> trap;
  };
  std::vector<LaneResult> lanes;
  /// what the error-free machine does not evaluate, on the twin of the first machine that did
  std::map<Key, Value> elsewhere;
  std::uint64_t touches = 0;
  EffectActivities activities;
};

/// Whether each machine may have limits of its own: by material conditions, or because the limits or the nominals that
/// they count from are computed from what it measured.
bool has_own_limits(const plan::Plan& plan, plan::CharacteristicId id) {
  const plan::CharacteristicDef& c = plan[id];
  return !c.widening.empty() || !plan[c.tolerance].varying.empty() ||
      std::any_of(c.features.begin(), c.features.end(), [&](plan::FeatureId f) { return !plan[f].varying.empty(); });
}

BlockResult::LaneResult kept(const Lane& lane, const plan::Plan& plan) {
  BlockResult::LaneResult out;
  out.values.reserve(lane.values.size());
  for (const Value& v : lane.values) {
    out.values.push_back({v.characteristic, v.visit, v.value});
    if (has_own_limits(plan, v.characteristic)) out.own_limits.push_back(v.limits);
  }
  if (!lane.trap.reason.empty()) out.trap = lane.trap;
  return out;
}

/// Enters what `lane` evaluated and the error-free machine did not, as the lane's twin saw it.
void keep_elsewhere(const Block& block, const Lane& lane, const std::set<Key>& referenced,
                    std::map<Key, Value>& elsewhere) {
  const std::vector<Value>& seen = block.lanes[lane.twin].values;
  auto next = seen.begin();  // lane and twin took the same path and evaluated in the same order
  for (const Value& v : lane.values) {
    const Key key{v.characteristic.value, v.visit};
    if (referenced.contains(key) || elsewhere.contains(key)) continue;
    next = std::find_if(next, seen.end(), [&](const Value& t) { return Key{t.characteristic.value, t.visit} == key; });
    elsewhere.emplace(key, next != seen.end() ? *next : v);  // a twin that stopped right here has none
  }
}

BlockResult run_block(const Executor& executor, const plan::Plan& plan, const VirtualMachines& machines,
                      const std::set<Key>& referenced, int first, int count) {
  Block block = executor.make_block(machines, first, count);
  executor.run(block);
  BlockResult result;
  result.touches = block.touches;
  result.activities = std::move(block.activities);
  for (int i = 0; i < count; ++i) {
    keep_elsewhere(block, block.lanes[i], referenced, result.elsewhere);
    result.lanes.push_back(kept(block.lanes[i], plan));
  }
  return result;
}

/// Lanes of one block: as many as asked for, but fewer for a long program, so that the memory of a block does
/// not grow with it.
int lanes_of_block(const Executor& executor, const RunOptions& options) {
  constexpr std::size_t kBlockMemory = 64 << 20, kFewest = 8;
  return std::max(
      1, std::min(options.block_lanes, static_cast<int>(std::max(kFewest, kBlockMemory / executor.lane_bytes()))));
}

/// Runs all blocks on `threads` threads; the first exception of a block ends the run.
std::vector<BlockResult> run_blocks(const Executor& executor, const plan::Plan& plan, const VirtualMachines& machines,
                                    const RunOptions& options, const std::set<Key>& referenced) {
  const int per_block = lanes_of_block(executor, options);
  const int blocks = (machines.size() + per_block - 1) / per_block;
  std::vector<BlockResult> results(blocks);
  on_threads(blocks, options.threads, [&](int b) {
    const int first = b * per_block;
    results[static_cast<std::size_t>(b)] =
        run_block(executor, plan, machines, referenced, first, std::min(per_block, machines.size() - first));
  });
  return results;
}

/// The samples of a run in the making.
class Collected {
 public:
  explicit Collected(const std::vector<Value>& reference) {
    for (const Value& v : reference) add(v, v.value);
  }

  /// The samples that a value belongs to; `elsewhere` describes what the error-free machine does not evaluate.
  Samples& of(const Key& key, const std::map<Key, Value>& elsewhere) {
    const auto found = slot_.find(key);
    return found != slot_.end() ? samples[found->second] : add(elsewhere.at(key), std::nullopt);
  }

  std::vector<Samples> samples;

 private:
  Samples& add(const Value& v, std::optional<double> reference) {
    slot_[{v.characteristic.value, v.visit}] = samples.size();
    return samples.emplace_back(Samples{v.characteristic, v.visit + 1, reference, v.nominal, v.limits, {}, {}, {}});
  }

  std::map<Key, std::size_t> slot_;
};

}  // namespace

const Samples* counterpart(const std::vector<Samples>& samples, std::size_t index, const RunResult& other) {
  const auto same = [&](const Samples& s) {
    return s.characteristic == samples[index].characteristic && s.occurrence == samples[index].occurrence;
  };
  // What the error-free machine evaluates comes first and in the same order.
  if (index < other.samples.size() && same(other.samples[index])) return &other.samples[index];
  const auto found = std::find_if(other.samples.begin(), other.samples.end(), same);
  return found == other.samples.end() ? nullptr : &*found;
}

RunResult run_plan(const plan::Plan& plan, const Machine& machine, const VirtualMachines& machines,
                   const RunOptions& options, const SourceFile& source) {
  Executor executor(plan, machine, options, source);
  ReferenceRun reference_ran = reference_run(executor, plan, machine, source);
  const Lane& reference = reference_ran.lane;

  RunResult result;
  result.machines = machines.size();
  result.activities.resize(machine.effects.size());
  result.reference_outputs = std::move(reference_ran.outputs);
  result.warnings = std::move(reference_ran.warnings);
  result.cycle_time_s = reference.motion->time_s();
  std::set<Key> referenced;
  for (const Value& v : reference.values) referenced.insert({v.characteristic.value, v.visit});
  Collected collected(reference.values);
  std::uint32_t machine_number = 0;
  for (BlockResult& block : run_blocks(executor, plan, machines, options, referenced)) {
    result.touches += block.touches;
    add_activities(block.activities, result.activities);
    for (BlockResult::LaneResult& lane : block.lanes) {
      auto own_limits = lane.own_limits.begin();
      for (const BlockResult::Kept& v : lane.values) {
        const bool own = has_own_limits(plan, v.characteristic);
        const auto limits = own ? own_limits++ : own_limits;
        Samples& samples = collected.of(v.key(), block.elsewhere);
        samples.value.push_back(v.value);
        if (own) samples.own_limits.push_back(*limits);
        samples.machine.push_back(machine_number);
      }
      if (lane.trap)
        result.traps.push_back(
            {machine_number, lane.trap->operation, plan.operations[lane.trap->operation].line, lane.trap->reason});
      ++machine_number;
    }
  }
  result.samples = std::move(collected.samples);
  return result;
}

MachineRecord record_plan(const plan::Plan& plan, const Machine& machine, const VirtualMachines& one,
                          const RunOptions& options, const SourceFile& source) {
  ABBE_CHECK(one.size() == 1);
  Executor executor(plan, machine, options, source);
  MachineRecord record;
  record.warnings = reference_run(executor, plan, machine, source).warnings;
  Block block = executor.make_block(one, 0, 1);
  Executor::Observed observed = executor.observe(block);
  const LaneTrap& trap = block.lanes[0].trap;
  if (!trap.reason.empty()) {
    throw UserError(diagnostic_at(source, plan.operations[trap.operation].span, Code::E0308,
                                  "the recorded machine cannot go on here: " + trap.reason,
                                  "choose another seed or smaller effects"));
  }
  record.recording.rows = std::move(observed.rows);
  record.aims = std::move(observed.aims);
  for (const plan::SensorDef& def : plan.sensors)
    record.recording.metadata.push_back(sensor_line(resolve_sensor(def, machine, source), machine));
  // What columns do not hold, where it was the same throughout.
  const auto tell = [&](const char* key, const auto& values, auto text) {
    if (values.size() == 1) record.recording.metadata.emplace_back(key, text(*values.begin()));
  };
  const auto length = [](double mm) { return fmt::format("{:.6g}", mm); };
  tell("approach_mm", observed.approaches_mm, length);
  tell("retract_mm", observed.retracts_mm, length);
  if (options.workpiece)
    tell("temperature_compensation", observed.compensations, [](bool on) { return on ? "on" : "off"; });
  record.outputs = std::move(observed.outputs);
  record.activities = std::move(block.activities);
  return record;
}

}  // namespace abbe
