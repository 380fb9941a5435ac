#include "engine/run/run.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "engine/run/placement.hpp"
#include "tests/unit/run/plan_builder.hpp"

using namespace abbe;
using namespace abbe::test;

namespace {

Arguments distance(std::string axis) {
  Arguments a;
  a.add_text("mode", "NOMINL");
  a.add_number("nominal", 0);
  a.add_number("lower", -1);
  a.add_number("upper", 1);
  a.add_text("axis", std::move(axis));
  return a;
}

/// Two points 200 mm apart along y, each with the head at its own orientation; the distance along y.
plan::Plan two_points(double a1_deg, double a2_deg) {
  PlanBuilder b;
  const auto first = b.sensor(a1_deg, 90, 150), second = b.sensor(a2_deg, 90, 150);
  b.append(plan::SelectSensor{first});
  const auto p = b.point({800, 400, -500}, {0, -1, 0});
  b.append(plan::SelectSensor{second});
  const auto q = b.point({800, 600, -500}, {0, 1, 0});
  b.evaluate({p, q}, "DISTB", distance("YAXIS"));
  return b.plan;
}

RunOptions only_head() {
  RunOptions options;
  options.contributors = {};
  options.contributors.geometry = options.contributors.probe = false;
  return options;
}

}  // namespace

TEST_CASE("without errors every machine sees the reference, exactly where the program puts the points") {
  const Machine machine = read_machine("coord3-mc16");
  RunOptions options = only_head();
  options.contributors.head = false;
  const RunResult r = run_plan(two_points(0, 0), machine, screened_machines(machine, 1, 5, 1), options, no_source());
  REQUIRE(r.samples.size() == 1);
  CHECK(r.samples[0].reference.value() == doctest::Approx(200).epsilon(1e-14));
  for (const double v : r.samples[0].value) CHECK(v == r.samples[0].reference.value());
}

TEST_CASE("with one orientation the head's errors cancel out of a length") {
  const Machine machine = read_machine("coord3-mc16");
  const RunResult r =
      run_plan(two_points(45, 45), machine, screened_machines(machine, 1, 200, 1), only_head(), no_source());
  for (const double v : r.samples[0].value) CHECK(std::fabs(v - 200) < 1e-9);
}

TEST_CASE("with two orientations the head's variance is that of the closed form") {
  // Both with B = 90: the tip is at (0, sinA l, -cosA l), so along y only A matters: dy/dA = l cosA. The two
  // indexings are independent: var = (l sd)^2 (cos^2 A1 + cos^2 A2).
  const Machine machine = read_machine("coord3-mc16");
  constexpr int n = 4000;
  const RunResult r =
      run_plan(two_points(20, 60), machine, screened_machines(machine, 1, n, 2), only_head(), no_source());
  const double sd = machine.head.sd_a_rad, a1 = 20 * kPi / 180, a2 = 60 * kPi / 180;
  const double expected = std::pow(150 * sd, 2) * (std::pow(std::cos(a1), 2) + std::pow(std::cos(a2), 2));
  // The variance of n normal numbers has a relative standard deviation of sqrt(2/(n-1)); 3.9 of them: false
  // alarms 1 in 10 000.
  CHECK(std::fabs(variance(r.samples[0].value) / expected - 1) < 3.9 * std::sqrt(2.0 / (n - 1)));
}

TEST_CASE("both angles of the head err by themselves") {
  // A = 45, B = 0: the tip at l (1, 0, -1) / sqrt 2 moves by l dA / sqrt 2 along x and by l dB / sqrt 2 along y. Along
  // (1, 1, 0) / sqrt 2 that is l (dA + dB) / 2, of which 1 / sqrt 2 shows in y: var = l^2 (sdA^2 + sdB^2) / 8. The
  // other point, touched along y by a tip straight below, shows neither angle.
  PlanBuilder b;
  const auto tilted = b.sensor(45, 0, 150), straight = b.sensor(0, 0, 150);
  b.append(plan::SelectSensor{tilted});
  const auto p = b.point({800, 400, -500}, unit({1, 1, 0}));
  b.append(plan::SelectSensor{straight});
  const auto q = b.point({800, 600, -500}, {0, 1, 0});
  b.evaluate({p, q}, "DISTB", distance("YAXIS"));
  const Machine machine = read_machine("coord3-mc16");
  constexpr int n = 4000;
  const double found = variance(
      run_plan(b.plan, machine, screened_machines(machine, 1, n, 2), only_head(), no_source()).samples[0].value);
  const HeadSpec& head = machine.head;
  const double expected = 150.0 * 150 / 8 * (head.sd_a_rad * head.sd_a_rad + head.sd_b_rad * head.sd_b_rad);
  CHECK(std::fabs(found / expected - 1) < 3.9 * std::sqrt(2.0 / (n - 1)));
}

TEST_CASE("the probe scatters along the axes of the head's last link, along each by itself") {
  Machine machine = read_machine("coord3-mc16");
  constexpr int n = 4000;
  constexpr double kSd_mm = 1e-3;
  RunOptions options = only_head();
  options.contributors.head = false, options.contributors.probe = true;
  const auto variance_of = [&](const plan::Plan& plan) {
    return variance(
        run_plan(plan, machine, screened_machines(machine, 1, n, 2), options, no_source()).samples[0].value);
  };
  const double chance = 3.9 * std::sqrt(2.0 / (n - 1));
  // Along the stylus: at A = B = 90 that is y, where two touches see it; straight below they do not.
  machine.probe.sd_mm = {0, 0, kSd_mm};
  CHECK(std::fabs(variance_of(two_points(90, 90)) / (2 * kSd_mm * kSd_mm) - 1) < chance);
  CHECK(variance_of(two_points(0, 0)) < 1e-20);
  // Two axes alike: along a normal between them the same scatter as along each, of which 1 / sqrt 2 shows along each.
  for (const auto& [first, second, axis] : {std::tuple{0, 1, "XAXIS"}, {1, 2, "YAXIS"}, {0, 2, "XAXIS"}}) {
    machine.probe.sd_mm = {};
    machine.probe.sd_mm[first] = machine.probe.sd_mm[second] = kSd_mm;
    PlanBuilder b;
    b.append(plan::SelectSensor{b.sensor(0, 0, 150)});
    Vec3 normal;
    normal[first] = normal[second] = std::sqrt(0.5);
    const auto p = b.point({700, 400, -500}, normal), q = b.point({900, 600, -500}, normal);
    b.evaluate({p, q}, "DISTB", distance(axis));
    CHECK(std::fabs(variance_of(b.plan) / (kSd_mm * kSd_mm) - 1) < chance);
  }
}

TEST_CASE("returning to an orientation indexes anew, selecting the same one again does not") {
  const Machine machine = read_machine("coord3-mc16");
  const auto distance_after = [&](bool leave) {
    PlanBuilder b;
    const auto straight = b.sensor(0, 0, 100), tilted = b.sensor(30, 90, 150);
    b.append(plan::SelectSensor{tilted});
    const auto p = b.point({800, 400, -500}, {0, -1, 0});
    if (leave) b.append(plan::SelectSensor{straight});
    b.append(plan::SelectSensor{tilted});
    const auto q = b.point({800, 600, -500}, {0, 1, 0});
    b.evaluate({p, q}, "DISTB", distance("YAXIS"));
    return variance(
        run_plan(b.plan, machine, screened_machines(machine, 1, 50, 1), only_head(), no_source()).samples[0].value);
  };
  CHECK(distance_after(false) < 1e-20);
  CHECK(distance_after(true) > 1e-8);
}

TEST_CASE("switching a contributor off changes no number of the others") {
  const Machine machine = read_machine("coord3-mc16");
  const VirtualMachines machines = screened_machines(machine, 1, 20, 1);
  const plan::Plan plan = two_points(10, 40);
  RunOptions all, geometry = all, rest = all;
  geometry.contributors.head = geometry.contributors.probe = false;
  rest.contributors.geometry = false;
  const auto values = [&](const RunOptions& o) {
    return run_plan(plan, machine, machines, o, no_source()).samples[0].value;
  };
  const auto sum = values(all), first = values(geometry), second = values(rest);
  for (std::size_t i = 0; i < sum.size(); ++i)
    CHECK((first[i] - 200) + (second[i] - 200) == doctest::Approx(sum[i] - 200).epsilon(1e-6));
}

TEST_CASE("a touch outside the travel is refused with its reading and the range") {
  PlanBuilder b;
  b.append(plan::SelectSensor{b.sensor(0, 0, 100)});
  b.point({5000, 400, -500}, {-1, 0, 0});
  const Machine machine = read_machine("coord3-mc16");
  try {
    run_plan(b.plan, machine, screened_machines(machine, 1, 1, 1), {}, no_source());
    FAIL("no error");
  } catch (const UserError& e) {
    REQUIRE(e.diagnostics().size() == 1);
    CHECK(e.diagnostics()[0].code == Code::E0302);
    CHECK(e.diagnostics()[0].message.find("4998.000") != std::string::npos);
  }
}

TEST_CASE("what no machine can do is an error at its operation: touching without a sensor") {
  PlanBuilder b;
  b.point({500, 400, -500}, {-1, 0, 0});
  const Machine machine = read_machine("coord3-mc16");
  try {
    run_plan(b.plan, machine, screened_machines(machine, 1, 1, 1), {}, no_source());
    FAIL("no error");
  } catch (const UserError& e) {
    CHECK(e.diagnostics()[0].code == Code::E0304);
  }
}

TEST_CASE("a sensor that the machine file does not have is refused with the nearest name") {
  PlanBuilder b;
  plan::SensorDef def;
  def.label = "STAR2O";
  def.from_machine_file = true;
  b.plan.sensors.push_back(def);
  b.append(plan::SelectSensor{{0}});
  Machine machine = read_machine("coord3-mc16");
  machine.sensors["STAR20"] = {0, 0, {0, 0, -100}, 2, 0, "", 0, 0};
  try {
    run_plan(b.plan, machine, screened_machines(machine, 1, 1, 1), {}, no_source());
    FAIL("no error");
  } catch (const UserError& e) {
    CHECK(e.diagnostics()[0].code == Code::E0301);
    CHECK(e.diagnostics()[0].help.find("STAR20") != std::string::npos);
  }
}

TEST_CASE("a program of another machine is moved into the z travel, and only there") {
  const Machine machine = read_machine("coord3-mc16");
  const auto placed = [&](const Vec3& point) {
    PlanBuilder b;
    b.append(plan::SelectSensor{b.sensor(0, 0, 100)});
    b.point(point, {0, 0, 1});
    return find_placement(b.plan, machine, no_source());
  };
  // The tip is 100 mm below the mount and the touch 2 mm above the point: 40 mm needs the reading 142,
  // outside [-800, 0].
  const Placement moved = placed({800, 400, 40});
  CHECK(moved.shift_mm == Vec3{0, 0, -542});
  REQUIRE(moved.message);
  CHECK(moved.message->code == Code::W0303);
  CHECK(placed({800, 400, -500}).shift_mm == Vec3{});
  CHECK_FALSE(placed({800, 400, -500}).message);
  CHECK_FALSE(placed({5000, 400, -500}).message);
  CHECK_FALSE(placed({800, 400, 9000}).message);
}

TEST_CASE("recording a machine that cannot go on is an error at its place") {
  // The square root of the error along y: some machines have a negative one, the error-free machine has exactly 0.
  PlanBuilder b;
  b.append(plan::SelectSensor{b.sensor(0, 0, 100)});
  const auto p = b.point({800, 400, -500}, {0, -1, 0});
  const plan::ColumnId y = b.column();
  b.append(plan::Obtain{y, p, plan::Quantity::y});
  b.append(plan::Assign{y, {plan::PushColumn{y}, plan::PushConstant{400}, plan::Op2::subtract, plan::Op1::sqrt}});
  const Machine machine = read_machine("coord3-mc16");
  int refused = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RunOptions options;
    options.seed = seed;
    try {
      const Recording recording =
          record_plan(b.plan, machine, screened_machines(machine, seed, 1, 1), options, no_source()).recording;
      CHECK(recording.rows.size() == 1);
    } catch (const UserError& e) {
      CHECK(e.diagnostics()[0].code == Code::E0308);
      ++refused;
    }
  }
  CHECK(refused > 2);
  CHECK(refused < 18);
}
