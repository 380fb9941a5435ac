// Programs whose path depends on measured values: machines part and meet again, and each must get exactly
// what it gets alone.
#include <doctest/doctest.h>

#include <algorithm>

#include "engine/lanes/random.hpp"
#include "engine/run/executor.hpp"
#include "tests/unit/run/plan_builder.hpp"

using namespace abbe;
using namespace abbe::plan;
using namespace abbe::test;

namespace {

/// A random program: measures points and, wherever a measured coordinate differs from its nominal by more or
/// less than a random threshold of the size of the errors, measures other points, builds another coordinate
/// system or loops back.
Plan random_program(std::uint32_t number) {
  std::uint32_t next = 0;
  const auto uniform = [&] { return uniform_pair({number, 0, stream_of("random program"), 0, 0, next++}).a; };
  PlanBuilder b;
  b.append(SelectSensor{b.sensor(0, 0, 150)});
  const SensorId tilted = b.sensor(45, 90, 150);
  b.plan.frames.resize(1);
  Arguments tolerance;
  tolerance.add_text("axis", "YAXIS");
  tolerance.add_number("lower", -1);
  tolerance.add_number("upper", 1);
  const ColumnId y = b.column(), rounds = b.column();
  b.append(Assign{rounds, {PushConstant{0}}});
  for (int step = 0; step < 6; ++step) {
    const double nominal_y = 300 + 300 * uniform();
    const int begin = static_cast<int>(b.plan.operations.size());
    const FeatureId p = b.point({600 + 300 * uniform(), nominal_y, -500}, {0, -1, 0});
    b.append(Obtain{y, p, Quantity::y});
    const double threshold = nominal_y + 0.004 * (uniform() - 0.5);
    const int branch = b.append(JumpUnless{{PushColumn{y}, PushConstant{threshold}, Op2::greater}, 0});
    if (step % 3 == 0) {
      b.append(SelectSensor{tilted});
      b.append(TranslateFrame{{0}, {OriginShift{Axis::y, p, {}}}});
      b.append(TranslateFrame{{0}, {OriginShift{Axis::y, {}, {-nominal_y, {}}}}});
    } else if (step % 3 == 1) {
      // Measures again, at most three times in the whole program.
      b.append(Assign{rounds, {PushColumn{rounds}, PushConstant{1}, Op2::add}});
      const int enough = b.append(JumpUnless{{PushColumn{rounds}, PushConstant{3}, Op2::less}, 0});
      b.append(Jump{begin});
      std::get<JumpUnless>(b.plan.operations[enough].action).target = static_cast<int>(b.plan.operations.size());
    } else {
      b.append(SelectSensor{tilted});
      b.point({700, nominal_y + 20, -520}, {0, -1, 0});
    }
    std::get<JumpUnless>(b.plan.operations[branch].action).target = static_cast<int>(b.plan.operations.size());
    b.evaluate({p}, "CORTOL", tolerance);
  }
  return b.plan;
}

RunResult run(const Plan& plan, const Machine& machine, const VirtualMachines& machines, int block_lanes, int threads) {
  RunOptions options;
  options.block_lanes = block_lanes;
  options.threads = threads;
  return run_plan(plan, machine, machines, options, no_source());
}

void check_same(const RunResult& a, const RunResult& b) {
  REQUIRE(a.samples.size() == b.samples.size());
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    CHECK(a.samples[i].reference == b.samples[i].reference);
    CHECK(a.samples[i].value == b.samples[i].value);
    CHECK(a.samples[i].machine == b.samples[i].machine);
  }
  CHECK(a.traps.size() == b.traps.size());
}

}  // namespace

TEST_CASE("machines on different paths get exactly what each gets alone, for any block size and thread count") {
  const Machine machine = read_machine("coord3-mc16");
  const VirtualMachines machines = screened_machines(machine, 1, 60, 1);
  for (std::uint32_t number = 1; number <= 20; ++number) {
    const Plan plan = random_program(number);
    const RunResult alone = run(plan, machine, machines, 1, 1);
    REQUIRE(alone.samples.size() >= 6);
    check_same(alone, run(plan, machine, machines, 7, 2));
    check_same(alone, run(plan, machine, machines, 128, 2));
  }
}

TEST_CASE("a loop over a column runs its body as often as it says, with new noise at each visit") {
  PlanBuilder b;
  b.append(SelectSensor{b.sensor(0, 0, 100)});
  const ColumnId i = b.column();
  b.append(Assign{i, {PushConstant{0}}});
  const int begin = static_cast<int>(b.plan.operations.size());
  const FeatureId p = b.point({800, 400, -500}, {0, -1, 0});
  Arguments a;
  a.add_text("axis", "YAXIS");
  a.add_number("lower", -1);
  a.add_number("upper", 1);
  b.evaluate({p}, "CORTOL", a);
  b.append(Assign{i, {PushColumn{i}, PushConstant{1}, Op2::add}});
  const int leave = b.append(JumpUnless{{PushColumn{i}, PushConstant{3}, Op2::less}, 0});
  b.append(Jump{begin});
  std::get<JumpUnless>(b.plan.operations[leave].action).target = static_cast<int>(b.plan.operations.size());

  const Machine machine = read_machine("coord3-mc16");
  const RunResult r = run(b.plan, machine, screened_machines(machine, 1, 10, 1), 128, 1);
  REQUIRE(r.samples.size() == 3);
  CHECK(r.samples[2].occurrence == 3);
  CHECK(r.samples[0].value != r.samples[1].value);
  CHECK(r.samples[1].value != r.samples[2].value);
}

TEST_CASE("an endless loop ends in a message, not in a hang") {
  PlanBuilder b;
  b.append(Jump{0});
  const Machine machine = read_machine("coord3-mc16");
  CHECK_THROWS_AS(run(b.plan, machine, screened_machines(machine, 1, 1, 1), 128, 1), UserError);
}

TEST_CASE("touches count as more than assignments, and still 100 000 may be made in a loop") {
  PlanBuilder b;
  b.append(SelectSensor{b.sensor(0, 0, 100)});
  const ColumnId i = b.column(), y = b.column();
  b.append(Assign{i, {PushConstant{0}}});
  const int begin = static_cast<int>(b.plan.operations.size());
  const FeatureId p = b.point({800, 400, -500}, {0, -1, 0});
  Arguments a;
  a.add_text("axis", "YAXIS");
  a.add_number("lower", -1);
  a.add_number("upper", 1);
  b.evaluate({p}, "CORTOL", a);
  b.append(Obtain{y, p, Quantity::y});
  b.append(Assign{i, {PushColumn{i}, PushConstant{1}, Op2::add}});
  const int leave = b.append(JumpUnless{{PushColumn{i}, PushConstant{100'000}, Op2::less}, 0});
  b.append(Jump{begin});
  const auto end = [&](Expression again) {
    b.plan.operations[leave].action = JumpUnless{std::move(again), static_cast<int>(b.plan.operations.size())};
  };
  const Machine machine = read_machine("coord3-mc16");
  const VirtualMachines one = screened_machines(machine, 1, 1, 1);

  end({PushColumn{i}, PushConstant{100'000}, Op2::less});
  const RunResult counted = run(b.plan, machine, one, 128, 1);
  CHECK(counted.touches == 100'000);
  CHECK(counted.traps.empty());

  end({PushColumn{y}, PushConstant{400}, Op2::not_equal});  // the error-free machine leaves at once
  const RunResult stuck = run(b.plan, machine, one, 128, 1);
  CHECK(stuck.traps.size() == 1);
  CHECK(stuck.touches < 200'000);
  CHECK(stuck.samples.size() > 100'000);  // sought one by one among the others, they would take a minute
}

TEST_CASE("what has no loop runs to its end, however long it is") {
  PlanBuilder b;
  b.append(SelectSensor{b.sensor(0, 0, 100)});
  b.point({800, 400, -500}, {0, -1, 0});
  auto& operations = b.plan.operations;
  const auto touch = std::find_if(operations.begin(), operations.end(),
                                  [](const Operation& o) { return std::holds_alternative<Touch>(o.action); });
  REQUIRE(touch != operations.end());
  constexpr int kTouches = 300'000;
  static_assert(kTouches * kTouchCost > kFuel);
  const Operation again = *touch;
  operations.insert(touch, kTouches - 1, again);
  const Machine machine = read_machine("coord3-mc16");
  CHECK(run(b.plan, machine, screened_machines(machine, 1, 1, 1), 128, 1).touches == kTouches);
}

TEST_CASE("a machine that cannot go on is trapped and counted; the others go on") {
  // Division by (y - reference) where the reference machine has y = 400 exactly: only a machine whose column
  // is negative fails.
  PlanBuilder b;
  b.append(SelectSensor{b.sensor(0, 0, 100)});
  const FeatureId p = b.point({800, 400, -500}, {0, -1, 0});
  Arguments a;
  a.add_text("axis", "YAXIS");
  a.add_number("lower", -1);
  a.add_number("upper", 1);
  const ColumnId y = b.column(), root = b.column();
  b.append(Obtain{y, p, Quantity::y});
  b.append(Assign{root, {PushColumn{y}, PushConstant{400}, Op2::subtract, Op1::sqrt}});
  b.evaluate({p}, "CORTOL", a);
  const Machine machine = read_machine("coord3-mc16");
  const RunResult r = run(b.plan, machine, screened_machines(machine, 1, 100, 1), 128, 1);
  REQUIRE(r.samples.size() == 1);
  CHECK(r.traps.size() > 20);
  CHECK(r.traps.size() < 80);
  CHECK(r.samples[0].value.size() + r.traps.size() == 100);
  CHECK(r.traps[0].line == 7);
}
