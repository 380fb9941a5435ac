#include "engine/plan/lifetimes.hpp"

#include <algorithm>
#include <functional>
#include <queue>
#include <type_traits>

namespace abbe::plan {

namespace {

template <class Action, class... Others>
constexpr bool is_one_of = (std::is_same_v<Action, Others> || ...);

/// One overload per action that names features, and one for all that name none, so that a new action does not
/// compile before it is here.
struct Naming {
  const Plan& plan;
  std::vector<FeatureId> named;

  void add(FeatureId feature) {
    if (feature.valid()) named.push_back(feature);
  }
  void operator()(const DefineFeature& o) { add(o.feature); }
  void operator()(const BeginMeasure& o) { add(o.feature); }
  void operator()(const Touch& o) { add(o.feature); }
  void operator()(const EndMeasure& o) { add(o.feature); }
  void operator()(const Construct& o) {
    add(o.result);
    for (const FeatureId from : o.from) add(from);
  }
  void operator()(const TakeNominal& o) { add(o.result), add(o.of); }
  void operator()(const SetDatumFrame& o) {
    for (const DatumRef& datum : o.datums) add(datum.feature);
  }
  void operator()(const TranslateFrame& o) {
    for (const OriginShift& shift : o.shifts) add(shift.from);
  }
  void operator()(const RotateFrame& o) { add(o.to); }
  void operator()(const Evaluate& o) {
    const CharacteristicDef& def = plan[o.characteristic];
    for (const FeatureId feature : def.features) add(feature);
    for (const MaterialCondition& condition : def.widening) add(condition.feature);
    for (const char* role : {"reference", "datum"})
      for (const int feature : plan[def.tolerance].arguments.features(role)) add({feature});
  }
  void operator()(const Output& o) {
    for (const FeatureId feature : o.features) add(feature);
  }
  void operator()(const Obtain& o) { add(o.feature); }
  void operator()(const ObtainDisplacement& o) { add(o.feature); }
  template <class Other>
  requires is_one_of<Other, SelectSensor, SetCompensation, SetTemperatureCompensation, SetMotion, Move, SetHome, GoHome,
                     SetMachineFrame, SetMatrixFrame, RecallFrame, OutputFrame, ObtainEvaluation, Assign, Jump,
                     JumpUnless>
  void operator()(const Other&) {}
};

int jump_target(const Action& action, int otherwise) {
  if (const auto* jump = std::get_if<Jump>(&action)) return jump->target;
  if (const auto* jump = std::get_if<JumpUnless>(&action)) return jump->target;
  return otherwise;
}

struct Life {
  FeatureId feature;
  int first = 0, last = 0;
};

/// In the order in which they begin.
std::vector<Life> lives(const Plan& plan) {
  std::vector<Life> of_feature(plan.features.size()), begun;
  const std::vector<Loop> repeated = loops(plan);
  auto loop = repeated.begin();
  for (int k = 0; k < static_cast<int>(plan.operations.size()); ++k) {
    while (loop != repeated.end() && loop->last < k) ++loop;
    const bool inside = loop != repeated.end() && loop->first <= k;
    for (const FeatureId feature : features_of(plan, plan.operations[k].action)) {
      Life& life = of_feature[feature.value];
      if (!life.feature.valid()) {
        life = {feature, inside ? loop->first : k, k};
        begun.push_back(life);
      }
      life.last = inside ? loop->last : k;
    }
  }
  for (Life& life : begun) life = of_feature[life.feature.value];
  return begun;
}

}  // namespace

std::vector<FeatureId> features_of(const Plan& plan, const Action& action) {
  Naming naming{plan, {}};
  std::visit(naming, action);
  return std::move(naming.named);
}

std::vector<Loop> loops(const Plan& plan) {
  std::vector<Loop> merged;
  for (int k = 0; k < static_cast<int>(plan.operations.size()); ++k) {
    Loop loop{jump_target(plan.operations[k].action, k + 1), k};
    if (loop.first > k) continue;
    for (; !merged.empty() && merged.back().last >= loop.first; merged.pop_back())
      loop.first = std::min(loop.first, merged.back().first);
    merged.push_back(loop);
  }
  return merged;
}

FeatureSlots feature_slots(const Plan& plan) {
  FeatureSlots slots{std::vector<int>(plan.features.size(), -1), 0};
  using Taken = std::pair<int, int>;  // last operation, slot
  std::priority_queue<Taken, std::vector<Taken>, std::greater<>> taken;
  for (const Life& life : lives(plan)) {
    int slot = slots.count;
    if (!taken.empty() && taken.top().first < life.first) {
      slot = taken.top().second;
      taken.pop();
    } else {
      ++slots.count;
    }
    slots.slot[life.feature.value] = slot;
    taken.emplace(life.last, slot);
  }
  return slots;
}

VisitCounters visit_counters(const Plan& plan) {
  VisitCounters counters{std::vector<int>(plan.operations.size(), -1), 0};
  for (const Loop& loop : loops(plan))
    for (int k = loop.first; k <= loop.last; ++k) {
      const Action& action = plan.operations[k].action;
      if (std::holds_alternative<Touch>(action) || std::holds_alternative<Evaluate>(action))
        counters.counter[k] = counters.count++;
    }
  return counters;
}

}  // namespace abbe::plan
