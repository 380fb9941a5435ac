// What a recording says of the part: points of the surface, its size, and where on the part they lie.
#include "engine/run/recorded/part.hpp"

#include <doctest/doctest.h>

#include "engine/run/part_frame.hpp"
#include "tests/unit/run/plan_builder.hpp"

using namespace abbe;
using namespace abbe::test;

namespace {

/// Six touches of a ball of 20 mm radius about (800, 500, -600), or of a hollow one, by a tip of 1 mm radius.
Recording sphere(bool inner, RecordedPoint point) {
  Recording r;
  r.point = point;
  for (const Vec3& out : {Vec3{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0.6, 0, 0.8}}) {
    RecordingRow row;
    row.feature = "BALL", row.touch = static_cast<int>(r.rows.size()) + 1;
    row.normal = inner ? -out : out;
    row.target_mm = Vec3{800, 500, -600} + 20 * out + (point == RecordedPoint::surface ? 0.0 : 1.0) * *row.normal;
    row.position_mm = *row.target_mm;
    r.rows.push_back(row);
  }
  return r;
}

}  // namespace

TEST_CASE("readings are those of the tip at the target, whichever point is recorded") {
  const Machine machine = read_machine("coord3-mc16");  // without sensors: 100 mm straight down, a ball of 2 mm
  for (const RecordedPoint point : {RecordedPoint::surface, RecordedPoint::tip_centre}) {
    const RecordedTouches t = recorded_touches(sphere(false, point), machine, "r");
    const TouchScene& s = t.touches[0].scene;
    CHECK(norm(s.point - Vec3{820, 500, -600}) < 1e-9);
    CHECK(norm(s.reading - (Vec3{821, 500, -500} - machine.home_offset())) < 1e-9);
  }
}

TEST_CASE("a larger ball is out of the material, a larger bore into it") {
  const Machine machine = read_machine("coord3-mc16");
  const Workpiece w = parse_workpiece(SourceFile(
      "w.json", R"({"schema": "abbe.workpiece/1", "name": "w", "surfaces": {"BALL": {"diameter_mm": 40.01}}})"));
  for (const bool inner : {false, true}) {
    const Recording r = sphere(inner, RecordedPoint::tip_centre);
    const RecordedPart part = recorded_part(w, r, recorded_touches(r, machine, "r"), "r");
    for (const double expected : part.expected_mm)
      CHECK(expected == doctest::Approx(inner ? -0.005 : 0.005).scale(1e-3));
  }
}

TEST_CASE("errors are added to the points that were recorded, of the surface or of the centre of the tip") {
  // A point 0.03 out along its normal; the place beside it does not count. The program's own tip has 2 mm radius.
  PlanBuilder b;
  b.append(plan::SelectSensor{b.sensor(0, 0, 150)});
  const auto p = b.point({800, 500, -500}, {1, 0, 0});
  Arguments a;
  a.add_text("axis", "XAXIS"), a.add_number("lower", -1), a.add_number("upper", 1);
  b.evaluate({p}, "CORTOL", a);
  const Machine machine = read_machine("coord3-mc16");
  for (const RecordedPoint point : {RecordedPoint::surface, RecordedPoint::tip_centre}) {
    Recording r;
    r.point = point;
    RecordingRow row;
    row.feature = "F0", row.touch = 1;
    row.position_mm = Vec3{800.03 + (point == RecordedPoint::surface ? 0 : 2), 500.4, -500};
    r.rows.push_back(row);
    RunOptions options;
    options.recorded = &r;
    const RunResult ran = run_plan(b.plan, machine, {}, options, no_source());
    CHECK(ran.samples[0].reference.value() == doctest::Approx(0.03));
  }
}

TEST_CASE("the origin of a part is the middle of what was touched in its first placement") {
  std::vector<AimedTouch> touches;
  const Rigid turned{rotation({0, 0, 1}, kPi / 2), {1000, 0, 0}};
  for (const Vec3& at : {Vec3{0, 0, 0}, {80, 0, 0}, {0, 40, 0}, {0, 0, 20}}) {
    const int index = static_cast<int>(touches.size()) + 1;
    touches.push_back({1, "P", index, at, {0, 0, 1}});
  }
  for (int k = 0; k < 4; ++k) touches.push_back({2, "P", k + 1, turned * touches[k].surface, {0, 0, 1}});
  const PartFrames frames(touches);
  const Vec3 expected = Vec3{80, 0, 0} - Vec3{20, 10, 5};
  CHECK(norm(frames.on_part(1, {80, 0, 0}) - expected) < 1e-9);
  CHECK(norm(frames.on_part(2, turned * Vec3{80, 0, 0}) - expected) < 1e-9);
}

TEST_CASE("a part is where its whole features are, though others were touched less often and are numbered anew") {
  std::vector<AimedTouch> touches;
  const Rigid turned{rotation({0, 0, 1}, kPi / 2), {1000, 0, 0}};
  const std::vector<Vec3> whole{{0, 0, 0}, {80, 0, 0}, {0, 40, 0}}, in_part{{0, 0, -10}, {30, 0, -10}, {80, 0, -10}};
  const auto touch = [&](int setup, const char* feature, int index, const Vec3& at) {
    touches.push_back({setup, feature, index, setup == 1 ? at : turned * at, {0, 0, 1}});
  };
  for (const int setup : {1, 2}) {
    for (int k = 0; k < 3; ++k) touch(setup, "TOP", k + 1, whole[k]);
    for (int k = setup - 1; k < 3; ++k) touch(setup, "SIDE", k + 2 - setup, in_part[k]);  // the first one is left out
  }
  const PartFrames frames(touches);
  CHECK(norm(frames.on_part(2, turned * in_part[2]) - frames.on_part(1, in_part[2])) < 1e-9);
}

TEST_CASE("of coordinate systems used as often the first is the part's") {
  const Rigid first{{}, {10, 0, 0}}, second{{}, {5, 0, 0}};
  FrameCount frames;
  for (const Rigid& X : {first, second, second, first}) frames.add(X, {1, 2, 3});
  CHECK(frames.of_part({}).p == first.p);
  frames.add(second, {1, 2, 3});
  CHECK(frames.of_part({}).p == second.p);
}
