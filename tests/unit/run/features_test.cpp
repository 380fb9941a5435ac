// What a run makes of features, patterns, criteria, touches and material conditions: end to end on the
// error-free machine, and the uncertainty of a 3-2-1 alignment against its closed form.
#include <doctest/doctest.h>

#include <cmath>

#include "engine/run/run.hpp"
#include "tests/unit/run/plan_builder.hpp"

using namespace abbe;
using namespace abbe::test;
using doctest::Approx;

namespace {

const Vec3 kPart{700, 400, -500};  // where the parts of these tests lie, machine coordinates

Arguments zone(double value) {
  Arguments a;
  a.add_number("zone", value);
  return a;
}
Arguments limits(double lower, double upper) {
  Arguments a;
  a.add_number("lower", lower), a.add_number("upper", upper);
  return a;
}
Arguments coordinate(const char* axis) {
  Arguments a = limits(-1, 1);
  a.add_text("axis", axis);
  return a;
}

/// Measures the feature at points with normals, relative to kPart.
plan::FeatureId measured(PlanBuilder& b, Shape shape, Element nominal,
                         const std::vector<std::pair<Vec3, Vec3>>& touches,
                         FitCriterion criterion = FitCriterion::least_squares) {
  nominal.point += kPart;
  const plan::FeatureId id = b.feature(shape, nominal);
  b.append(plan::BeginMeasure{id});
  for (const auto& [p, n] : touches) b.append(plan::Touch{id, constant(kPart + p), constant(n), true});
  b.append(plan::EndMeasure{id, criterion});
  return id;
}

plan::FeatureId by_pattern(PlanBuilder& b, Shape shape, Element nominal, int count, bool inner = false) {
  nominal.point += kPart;
  const plan::FeatureId id = b.feature(shape, nominal);
  b.plan.features.back().inner = inner;
  b.append(plan::BeginMeasure{id});
  for (int k = 0; k < count; ++k) {
    plan::Touch touch{id, {}, {}, false};
    touch.pattern_index = k, touch.pattern_count = count;
    b.append(touch);
  }
  b.append(plan::EndMeasure{id});
  return id;
}

RunResult run(const plan::Plan& plan, int machines, const RunOptions& options = {}) {
  const Machine machine = read_machine("coord3-mc16");
  return run_plan(plan, machine, screened_machines(machine, 1, machines, 1), options, no_source());
}

RunOptions only_probe() {
  RunOptions options;
  options.contributors.geometry = options.contributors.head = false;
  return options;
}

}  // namespace

TEST_CASE("every kind with default points is found where its nominal is") {
  for (const FeatureKind* kind : feature_kinds()) {
    const Shape s = kind->shape;
    if (!kind->pattern.touch) continue;
    CAPTURE(std::string(kind->word));
    Element nominal{.point = {10, 20, 0}, .direction = {0, 0, 1}, .size = 15, .minor_size = 6, .second = {1, 0, 0}};
    if (s == Shape::arc) nominal.angle = 2;
    if (s == Shape::line) nominal.second = {0, 1, 0}, nominal.begin = -30, nominal.end = 30;
    PlanBuilder b;
    b.append(plan::SelectSensor{b.sensor(0, 0, 150)});
    const auto id = by_pattern(b, s, nominal, 12, true);
    for (const char* axis : {"XAXIS", "YAXIS", "ZAXIS"}) b.evaluate({id}, "CORTOL", coordinate(axis));
    const bool height_is_free = s == Shape::cylinder;  // the point of the axis nearest to the touches
    const RunResult r = run(b.plan, 0);
    for (std::size_t k = 0; k < (height_is_free ? 2 : 3); ++k) CHECK(std::fabs(r.samples[k].reference.value()) < 1e-9);
  }
}

TEST_CASE("default points stay with the system in which their feature was defined") {
  PlanBuilder b;
  b.append(plan::SelectSensor{b.sensor(0, 0, 150)});
  const auto circle = b.feature(Shape::circle, {.point = kPart, .direction = {0, 0, 1}, .size = 20});
  b.plan.frames.push_back({"MOVED"});
  b.append(plan::TranslateFrame{{0}, {{Axis::x, {}, {50, {}}}}});
  b.append(plan::BeginMeasure{circle});
  for (int k = 0; k < 4; ++k) {
    plan::Touch touch{circle, {}, {}, false};
    touch.pattern_index = k, touch.pattern_count = 4;
    b.append(touch);
  }
  b.append(plan::EndMeasure{circle});
  b.evaluate({circle}, "CORTOL", coordinate("XAXIS"));
  CHECK(std::fabs(run(b.plan, 0).samples[0].reference.value()) < 1e-9);
}

TEST_CASE("criteria, profile and run-out see the touches themselves") {
  PlanBuilder b;
  b.append(plan::SelectSensor{b.sensor(0, 0, 150)});
  const Element hub{.point = {0, 0, 0}, .direction = {0, 0, 1}, .size = 10};
  const std::vector<std::pair<Vec3, Vec3>> round = {
      {{10, 0, 0}, {1, 0, 0}}, {{0, 10, 0}, {0, 1, 0}}, {{-10.04, 0, 0}, {-1, 0, 0}}, {{0, -10, 0}, {0, -1, 0}}};
  const auto inscribed = measured(b, Shape::circle, hub, round, FitCriterion::maximum_inscribed);
  b.evaluate({inscribed}, "DIAM", limits(-1, 1));
  const auto around = measured(b, Shape::circle, hub, round, FitCriterion::minimum_circumscribed);
  b.evaluate({around}, "DIAM", limits(-1, 1));
  const auto datum =
      measured(b, Shape::circle, hub, {{{10, 0, 0}, {1, 0, 0}}, {{0, 10, 0}, {0, 1, 0}}, {{-10, 0, 0}, {-1, 0, 0}}});
  Arguments about = zone(0.1);
  about.add_feature("datum", datum.value);
  b.evaluate({around}, "CRNOUT", about);
  b.evaluate({around}, "PROFS", limits(-0.1, 0.1));
  const RunResult r = run(b.plan, 20);
  // Inside, three touches at 10 and one at 10.04: the circle through (0, +-10) and the near side may move by
  // 0.02 to the far one.
  CHECK(r.samples[0].reference.value() == Approx(20.0).epsilon(1e-5));
  CHECK(r.samples[0].reference.value() >= 20.0);
  CHECK(r.samples[1].reference.value() == Approx(20.04).epsilon(1e-9));
  CHECK(r.samples[2].reference.value() == Approx(0.04).epsilon(1e-9));
  CHECK(r.samples[3].reference.value() == Approx(0).epsilon(1e-9));  // the touches are where the program put them
  for (const Samples& s : r.samples) CHECK(s.value.size() == 20);
}

TEST_CASE("a material condition gives every machine limits of its own") {
  PlanBuilder b;
  b.append(plan::SelectSensor{b.sensor(0, 0, 150)});
  Element hole{.point = {0, 0, 0}, .direction = {0, 0, 1}, .size = 10};
  const auto id = by_pattern(b, Shape::circle, hole, 6, true);
  const auto size = b.evaluate({id}, "DIAM", limits(-0.1, 0.2));
  Arguments position = zone(0.05);
  position.add_text("space", "2D");
  const auto pos = b.evaluate({id}, "POS", position);
  b.plan.characteristics[static_cast<std::size_t>(pos.value)].widening = {
      {id, b.plan.characteristics[static_cast<std::size_t>(size.value)].tolerance, Condition::maximum_material}};
  const RunResult r = run(b.plan, 50);
  const Samples &diameters = r.samples[0], &positions = r.samples[1];
  CHECK(positions.limits.upper == Approx(0.05 + 0.1));
  REQUIRE(positions.own_limits.size() == 50);
  CHECK(diameters.own_limits.empty());
  for (std::size_t i = 0; i < 50; ++i)
    CHECK(*positions.own_limits[i].upper == Approx(0.05 + diameters.value[i] - 19.9).epsilon(1e-12));
}

TEST_CASE("the uncertainty of a 3-2-1 alignment is that of the closed form") {
  // Three touches on the face z = 0, two on y = 0, one on x = 0, L apart. In the frame that they make, a touch
  // at (x, y) far away has, with the noise sd of one touch and e1..e6 the errors of the six:
  //   z: 1 + (1 - x/L - y/L)^2 + (x/L)^2 + (y/L)^2           the plane through three points
  //   y: 1 + (1 - x/L)^2 + (x/L)^2                           the line through two
  //   x: 2 + 2 ((y - yc)/L)^2                                the point, and the rotation times the lever
  // all times sd^2; heights are equal, so that the tilt of the face does not act on x and y.
  constexpr double L = 100, depth = -10, yc = 50;
  constexpr int n = 4000;
  PlanBuilder b;
  b.append(plan::SelectSensor{b.sensor(0, 0, 150)});
  const Vec3 up{0, 0, 1}, front{0, -1, 0}, left{-1, 0, 0};
  const auto face =
      measured(b, Shape::plane, {.point = {}, .direction = up}, {{{0, 0, 0}, up}, {{L, 0, 0}, up}, {{0, L, 0}, up}});
  const auto edge = measured(b, Shape::line, {.point = {0, 0, depth}, .direction = {1, 0, 0}},
                             {{{0, 0, depth}, front}, {{L, 0, depth}, front}});
  const auto stop = measured(b, Shape::point, {.point = {0, yc, depth}, .direction = left}, {{{0, yc, depth}, left}});
  b.plan.frames.push_back({"PART"});
  plan::SetDatumFrame set{{0}, {}};
  set.datums.push_back({face, true, {Axis::z, 1}, {false, false, true}});
  set.datums.push_back({edge, true, {Axis::x, 1}, {false, true, false}});
  set.datums.push_back({stop, false, {}, {true, false, false}});
  b.append(set);
  const auto in_part = [&](const Vec3& p, const Vec3& normal, const char* axis) {
    const plan::FeatureId id = b.feature(Shape::point, {.point = p, .direction = normal});
    b.append(plan::BeginMeasure{id});
    b.append(plan::Touch{id, constant(p), constant(normal), true});
    b.append(plan::EndMeasure{id});
    b.evaluate({id}, "CORTOL", coordinate(axis));
  };
  constexpr double x = 250, y = 180;
  in_part({x, y, 0}, up, "ZAXIS");
  in_part({x, 0, depth}, front, "YAXIS");
  in_part({0, y, depth}, left, "XAXIS");
  const RunResult r = run(b.plan, n, only_probe());
  const Machine machine = read_machine("coord3-mc16");
  const Vec3 sd = machine.probe.sd_mm;
  const double z_form = 1 + std::pow(1 - x / L - y / L, 2) + std::pow(x / L, 2) + std::pow(y / L, 2);
  const double y_form = 1 + std::pow(1 - x / L, 2) + std::pow(x / L, 2);
  // The lever turns errors along y into errors along x.
  const double x_form = 2 * sd.x * sd.x + 2 * std::pow((y - yc) / L, 2) * sd.y * sd.y;
  const double expected[] = {sd.z * sd.z * z_form, sd.y * sd.y * y_form, x_form};
  for (std::size_t k = 0; k < 3; ++k) {
    CAPTURE(k);
    CHECK(std::fabs(r.samples[k].reference.value()) < 1e-9);
    // As above: 3.9 standard deviations of the variance of n normal numbers.
    CHECK(std::fabs(variance(r.samples[k].value) / expected[k] - 1) < 3.9 * std::sqrt(2.0 / (n - 1)));
  }
}

TEST_CASE("the point of a cone is its apex in coordinate systems and constructions") {
  // Cones of 90 degrees, open upwards; their apexes lie 20 mm below the part, those of their nominals 21.
  PlanBuilder b;
  b.append(plan::SelectSensor{b.sensor(0, 0, 150)});
  std::vector<plan::FeatureId> cones;
  for (const double x : {0.0, 60.0}) {
    std::vector<std::pair<Vec3, Vec3>> touches;
    for (const double height : {8.0, 14.0})
      for (const Vec3 out : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{-1, 0, 0}, Vec3{0, -1, 0}})
        touches.push_back({Vec3{x, 0, height - 20} + height * out, unit(out - Vec3{0, 0, 1})});
    cones.push_back(
        measured(b, Shape::cone, {.point = {x, 0, -21}, .direction = {0, 0, 1}, .angle = kPi / 4}, touches));
  }
  const auto row = b.feature(Shape::line, {.point = kPart, .direction = {1, 0, 0}, .second = {0, 0, 1}});
  b.append(plan::Construct{row, find_construction("BF"), cones, {}});
  b.plan.frames.push_back({"APEX"});
  b.append(plan::TranslateFrame{{0}, {{Axis::z, cones[0], {}}}});
  const auto mark = b.point({700, 400, 20}, {0, 0, 1});
  b.append(plan::Output{{mark}, {}});
  b.plan.frames.push_back({"MACHINE"});
  b.append(plan::SetMachineFrame{{1}});
  b.append(plan::Output{{row, mark}, {}});
  const RunResult r = run(b.plan, 0);
  REQUIRE(r.reference_outputs.size() == 2);
  CHECK(r.reference_outputs[0].features[0].point.z == Approx(20));
  CHECK(r.reference_outputs[1].features[0].point.z == Approx(kPart.z - 20));
  CHECK(r.reference_outputs[1].features[1].point.z == Approx(kPart.z));
}

TEST_CASE("what is programmed lies in the coordinate system that each machine made for itself") {
  // z starts where each machine touched the face; the nominal is programmed 20 above it, in whatever machine.
  PlanBuilder b;
  b.append(plan::SelectSensor{b.sensor(0, 0, 150)});
  b.plan.frames = {{"MACHINE"}, {"FACE"}};
  b.append(plan::SetMachineFrame{{0}});
  const auto face = b.point(kPart, {0, 0, 1});
  b.append(plan::TranslateFrame{{1}, {{Axis::z, face, {}}}});
  const auto above = b.feature(Shape::point, {.point = {kPart.x, kPart.y, 20}, .direction = {0, 0, 1}});
  b.plan.features.push_back(b.plan.features.back());
  const plan::FeatureId nominal{above.value + 1};
  b.append(plan::TakeNominal{nominal, above});
  Arguments apart = limits(-1, 1);
  apart.add_text("axis", "ZAXIS");
  for (const int frame : {1, 0}) {
    b.append(plan::RecallFrame{{frame}});
    b.evaluate({face, nominal}, "DISTB", apart);
  }
  constexpr int n = 50;
  const RunResult r = run(b.plan, n, only_probe());
  for (const Samples& s : r.samples) {
    CHECK(s.reference.value() == Approx(20));
    REQUIRE(s.value.size() == n);
    for (const double v : s.value) CHECK(std::fabs(v - 20) < 1e-9);
  }
}

TEST_CASE("a coordinate system recalled is the one that was made") {
  PlanBuilder b;
  b.append(plan::SelectSensor{b.sensor(0, 0, 150)});
  b.plan.frames = {{"A"}, {"B"}, {"C"}, {"D"}};
  b.append(plan::SetMachineFrame{{0}});
  b.append(plan::TranslateFrame{{1}, {{Axis::x, {}, {700, {}}}, {Axis::y, {}, {400, {}}}, {Axis::z, {}, {-500, {}}}}});
  plan::RotateFrame turn{};
  turn.result = {2}, turn.axis = Axis::z, turn.angle_rad = {kPi / 2, {}};
  b.append(turn);
  const Rigid known{{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}, {700, 400, -500}};
  b.append(plan::SetMatrixFrame{{3}, known});
  std::vector<plan::FeatureId> points;
  for (const int frame : {2, 3}) {
    b.append(plan::RecallFrame{{0}});
    b.append(plan::RecallFrame{{frame}});
    points.push_back(b.point({10, 20, 5}, {0, 0, 1}));
  }
  b.append(plan::RecallFrame{{0}});
  // (10, 20) turned by a quarter is (-20, 10).
  points.push_back(b.point({680, 410, -495}, {0, 0, 1}));
  Arguments apart = limits(0, 1);
  apart.add_text("axis", "PT2PT");
  b.evaluate({points[0], points[1]}, "DISTB", apart);  // the chain of translation and rotation is the matrix
  b.evaluate({points[0], points[2]}, "DISTB", apart);
  const RunResult r = run(b.plan, 0);
  for (const Samples& s : r.samples) CHECK(s.reference.value() < 1e-9);
}
