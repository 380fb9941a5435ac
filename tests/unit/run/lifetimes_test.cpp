#include "engine/plan/lifetimes.hpp"

#include <doctest/doctest.h>

#include "engine/run/executor.hpp"
#include "tests/unit/run/plan_builder.hpp"

using namespace abbe;
using namespace abbe::plan;
using namespace abbe::test;

namespace {

Arguments along_z() {
  Arguments arguments;
  arguments.add_text("axis", "ZAXIS");
  arguments.add_number("lower", -1);
  arguments.add_number("upper", 1);
  return arguments;
}

/// Points measured one after the other, each evaluated at once.
PlanBuilder points(int count) {
  PlanBuilder b;
  b.append(SelectSensor{b.sensor(0, 0, 100)});
  for (int i = 0; i < count; ++i) b.evaluate({b.point({500.0 + i, 400, -500}, {0, 0, 1})}, "CORTOL", along_z());
  return b;
}

std::vector<std::pair<int, int>> loops_of(std::vector<Action> actions) {
  PlanBuilder b;
  for (Action& action : actions) b.append(std::move(action));
  std::vector<std::pair<int, int>> out;
  for (const Loop& loop : loops(b.plan)) out.emplace_back(loop.first, loop.last);
  return out;
}

using Pairs = std::vector<std::pair<int, int>>;

}  // namespace

TEST_CASE("features that are never alive together share a slot") {
  const FeatureSlots slots = feature_slots(points(50).plan);
  CHECK(slots.count == 1);
  CHECK(slots.slot == std::vector<int>(50, 0));
}

TEST_CASE("a block needs memory for what is alive and what is evaluated, not for all that is measured") {
  const Machine machine = read_machine("coord3-mc16");
  const auto bytes = [&](const Plan& plan) { return Executor(plan, machine, {}, SourceFile("test", "")).lane_bytes(); };
  CHECK(bytes(points(1000).plan) - bytes(points(10).plan) == 990 * sizeof(Value));
}

TEST_CASE("a feature lives as long as anything names it") {
  const FeatureId first{0}, second{1};
  Arguments datum = along_z();
  datum.add_feature("datum", first.value);
  DatumRef axis;
  axis.feature = first;
  PlanBuilder b = points(2);
  b.plan.tolerances.push_back({"D", find_tolerance_kind("CORTOL"), datum, {}});
  b.plan.characteristics.push_back({{second}, {2}, 0, {}});
  b.plan.characteristics.push_back({{second}, {1}, 0, {{first, {0}, Condition::maximum_material}}});
  const Action uses[] = {BeginMeasure{first},
                         EndMeasure{first},
                         Construct{second, nullptr, {first}, {}},
                         Construct{first, nullptr, {}, {}},
                         SetDatumFrame{{0}, {axis}},
                         TranslateFrame{{0}, {OriginShift{Axis::x, first, {}}}},
                         RotateFrame{{0}, Axis::z, first, {}, {}},
                         Evaluate{{0}},
                         Evaluate{{2}},
                         Evaluate{{3}},
                         Output{{first}, {}},
                         Obtain{{0}, first},
                         ObtainDisplacement{{0}, first}};
  for (const Action& use : uses) {
    CAPTURE(use.index());
    PlanBuilder used = b;
    used.append(use);
    CHECK(feature_slots(used.plan).count == 2);
  }
  b.append(Jump{static_cast<int>(b.plan.operations.size()) + 1});
  CHECK(feature_slots(b.plan).count == 1);
}

TEST_CASE("loops that overlap or stand inside each other are one") {
  CHECK(loops_of({Jump{1}, JumpUnless{{}, 3}, Jump{3}}) == Pairs{});
  CHECK(loops_of({Jump{0}, SetCompensation{}, Jump{1}}) == Pairs{{0, 0}, {1, 2}});
  CHECK(loops_of({GoHome{}, GoHome{}, Jump{1}, Jump{0}}) == Pairs{{0, 3}});
  CHECK(loops_of({GoHome{}, GoHome{}, Jump{0}, GoHome{}, JumpUnless{{}, 1}, Jump{5}}) == Pairs{{0, 4}, {5, 5}});
}

TEST_CASE("what a loop names lives through all of it") {
  PlanBuilder b = points(1);
  const int begin = static_cast<int>(b.plan.operations.size());
  b.append(Obtain{b.column(), {0}});  // the next round wants it again
  b.evaluate({b.point({600, 400, -500}, {0, 0, 1})}, "CORTOL", along_z());
  CHECK(feature_slots(b.plan).count == 1);
  b.append(Jump{begin});
  CHECK(feature_slots(b.plan).count == 2);
}

TEST_CASE("only what may run again is counted") {
  PlanBuilder b = points(3);
  CHECK(visit_counters(b.plan).count == 0);
  const int begin = static_cast<int>(b.plan.operations.size());
  b.evaluate({b.point({600, 400, -500}, {0, 0, 1})}, "CORTOL", along_z());
  b.append(Jump{begin});
  CHECK(visit_counters(b.plan).count == 2);
}
