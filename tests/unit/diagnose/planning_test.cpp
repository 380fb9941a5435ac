// What is proposed as the next measurement: where the tip goes, what a change leaves as it was, and how a
// part is found that was moved.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/diagnose/baseline/machine_effects.hpp"
#include "engine/diagnose/planning/alignment.hpp"
#include "engine/diagnose/planning/changes.hpp"
#include "engine/diagnose/planning/labels.hpp"
#include "engine/diagnose/planning/next_measurement.hpp"
#include "engine/diagnose/planning/path.hpp"
#include "engine/diagnose/planning/program.hpp"
#include "engine/diagnose/planning/second_recording.hpp"
#include "engine/diagnose/planning/shape.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

constexpr double kTip_mm = 2;
const Vec3 kBore{600, 450, -600};

/// A block with its top at z = -600, two sides, a bore of 20 mm and a pin of 40 mm, touched from above.
struct TouchedBlock {
  Machine machine = read_machine("coord3-mc16");
  Recording recording;
  Case c;

  explicit TouchedBlock(RecordedPoint point = RecordedPoint::tip_centre) {
    machine.sensors["P"] = {
        .tip_in_r_mm = {0, 0, -100}, .radius_mm = kTip_mm, .material = "", .young_GPa = 600, .cte_ppm_per_K = 5};
    recording.point = point;
    for (const double x : {500.0, 800.0})
      for (const double y : {400.0, 600.0}) touch("TOP", {x, y, -600}, {0, 0, 1});
    for (const double x : {500.0, 800.0}) touch("FRONT", {x, 390, -620}, {0, -1, 0});
    touch("LEFT", {490, 500, -620}, {-1, 0, 0});
    for (const double z : {-605.0, -615.0}) round("BORE", kBore + Vec3{0, 0, z + 600}, -10);
    round("PIN", {700, 500, -580}, 20);
    c.recording = &recording, c.machine = &machine;
    c.touches = recorded_touches(recording, machine, "");
  }

  void round(const std::string& feature, const Vec3& centre, double radius_mm) {
    constexpr int kTouches = 4;
    for (int k = 0; k < kTouches; ++k) {
      const double a = 2 * kPi * k / kTouches;
      const Vec3 out{std::cos(a), std::sin(a), 0};
      touch(feature, centre + std::abs(radius_mm) * out, radius_mm < 0 ? -out : out);
    }
  }

  void touch(const std::string& feature, const Vec3& surface, const Vec3& normal) {
    RecordingRow row;
    row.feature = feature;
    row.touch = 1 +
        static_cast<int>(std::count_if(recording.rows.begin(), recording.rows.end(),
                                       [&](const RecordingRow& r) { return r.feature == feature; }));
    row.normal = normal;
    row.target_mm = row.position_mm = recording.point == RecordedPoint::surface ? surface : surface + kTip_mm * normal;
    row.sensor = "P", row.head_a_deg = 0, row.head_b_deg = 0, row.visit = 1;
    row.time_s = 10.0 * double(recording.rows.size()), row.speed_mm_s = 5;
    recording.rows.push_back(row);
  }

  Change change(const std::string& words) const {
    for (const Change& change : changes_for(c))
      if (change.text.find(words) != std::string::npos) return change;
    FAIL("no change " << words);
    return {};
  }
};

std::string feature_of(const Longer& l, std::size_t k) {
  return l.touches.features[static_cast<std::size_t>(l.touches.touches[k].scene.feature)];
}

}  // namespace

TEST_CASE("another ball touches the same surface, whatever the recording holds") {
  for (const RecordedPoint point : {RecordedPoint::tip_centre, RecordedPoint::surface}) {
    const TouchedBlock block(point);
    const auto longer = repeated(block.c, block.change("stylus ball"));
    REQUIRE(longer);
    for (std::size_t k = 0; k < longer->first; ++k) {
      const TouchScene &before = longer->touches.touches[k].scene,
                       &after = longer->touches.touches[longer->first + k].scene;
      CHECK(after.stylus.radius_mm == doctest::Approx(kTip_mm / 2));
      CHECK(norm(after.point - before.point) < 1e-9);
    }
  }
}

TEST_CASE("what faces away from the stylus after a change is not touched again") {
  const TouchedBlock block;
  // The front would face away from the stylus, were the part tilted forward.
  const Change tilt = block.change("tilted by -20 degrees about X");
  const auto longer = repeated(block.c, tilt), turned = repeated(block.c, block.change("turned by 90 degrees"));
  REQUIRE(longer);
  REQUIRE(turned);
  CHECK(longer->left_out == 3);  // of bore and pin what faces the other way
  CHECK(longer->touches.touches.size() == 2 * longer->first - 3);
  for (std::size_t k = longer->first; k < longer->touches.touches.size(); ++k) {
    const TouchScene& s = longer->touches.touches[k].scene;
    CHECK(dot(s.normal, s.stylus.to_head) > -1e-9);
    CHECK(feature_of(*longer, k) == feature_of(*longer, static_cast<std::size_t>(longer->same_as[k])));
  }
  const std::string program = dmis_program(block.c, *longer, tilt);
  CHECK(program.find("3 touches of the first recording are left out") != std::string::npos);
  CHECK(program.find("touched here of BORE are its touches 1, 2, 3, 5, 6, 7: put these numbers") != std::string::npos);
  CHECK(turned->left_out == 0);
}

TEST_CASE("of two changes at once a part is put down once and one stylus is mounted") {
  const TouchedBlock block;
  const Change ball = block.change("stylus ball of"), length = block.change("stylus of"),
               slow = block.change("probing speed");
  const Change both = joined(ball, length);
  CHECK(both.instruction == "mount a stylus with " + ball.mounted + " and " + length.mounted + ", and qualify it");
  CHECK(both.minutes == ball.minutes);
  CHECK(both.text == ball.text + " and with a" + length.text.substr(length.text.find(" stylus of")));
  CHECK(joined(length, slow).instruction == length.instruction);
  CHECK(joined(length, slow).minutes == length.minutes + slow.minutes);
  const Change turned = block.change("turned by 90"), tilted = block.change("about Y");
  const Change placed = joined(turned, tilted);
  CHECK(placed.placed == turned.placed + " and then " + tilted.placed);
  CHECK(placed.instruction.find("align it again") == placed.instruction.rfind("align it again"));
}

TEST_CASE("a part that is moved, or that was left for hours, is in another setup and all else in another run") {
  TouchedBlock block;
  for (RecordingRow& row : block.recording.rows) row.temp_part_C = 20;
  block.c.touches = recorded_touches(block.recording, block.machine, "");
  for (const Change& change : changes_for(block.c)) {
    const auto longer = repeated(block.c, change);
    if (!longer) continue;
    INFO(change.text);
    const bool placed =
        change.text.find("the part ") != std::string::npos || change.text.find("K higher") != std::string::npos;
    CHECK(longer->recording.rows.back().setup == (placed ? 2 : 1));
    CHECK(longer->recording.rows.back().run == 2);
    const bool qualified =
        change.text.find("stylus") != std::string::npos || change.text.find("head") != std::string::npos;
    // A second file that does not say otherwise was qualified anew, too.
    CHECK(longer->recording.rows.back().qualification == (qualified ? 3 : 2));
    const std::string said = recording_sentence(*longer);
    CHECK((said.find("and setup 2: for the diagnosis the part stands elsewhere") != std::string::npos) == placed);
    CHECK((said.find("must not be touched in between: if it was, or was left for hours, give setup 2") !=
           std::string::npos) == !placed);
  }
}

TEST_CASE("of several placements each has a setup of its own, and a new one where the part is put down anew") {
  TouchedBlock block;
  for (RecordingRow& row : block.recording.rows) row.setup = row.feature == "BORE" || row.feature == "PIN" ? 2 : 1;
  block.c.touches = recorded_touches(block.recording, block.machine, "");
  for (const Change& change : changes_for(block.c)) {
    const auto longer = repeated(block.c, change);
    if (!longer) continue;
    INFO(change.text);
    const std::string said = recording_sentence(*longer), program = dmis_program(block.c, *longer, change);
    // The recording ends in setup 2: what begins with it may leave the part there.
    const bool stays = change.reversed && !change.new_setup;
    const std::string setups = stays ? "2, 3" : change.reversed ? "4, 3" : "3, 4";
    CHECK(said.find("setups " + setups + ", one for each placement in this order") != std::string::npos);
    CHECK(said.find("put down anew stands elsewhere for the diagnosis") != std::string::npos);
    CHECK((said.find("2 only if the part is not touched before it, else 4") != std::string::npos) == stays);
    CHECK((program.find("leave the part as it stands, for setup 2 of this recording") != std::string::npos) == stays);
    for (const int setup : {1, 2})
      CHECK((program.find(fmt::format("put the part as in setup {} of the first recording, for setup {} of this one",
                                      setup, setup + 2)) != std::string::npos) == !(stays && setup == 2));
  }
}

TEST_CASE("a repetition has the noise of what it repeats") {
  TouchedBlock block;
  Case& c = block.c;
  c.baseline = baseline_of(c.touches, block.machine, {});
  LinearModel& own = c.baseline.model;
  own.noise_groups = 2;
  for (std::size_t i = own.noise_group.size() / 2; i < own.noise_group.size(); ++i) own.noise_group[i] = 1;
  c.rounding_um = 3;
  add_rounding(block.machine, c.rounding_um, own);
  const auto longer = repeated(c, block.change("once more"));
  REQUIRE(longer);
  REQUIRE(longer->touches.touches.size() == 2 * longer->first);
  const LinearModel both = baseline_of(c, *longer).model;
  CHECK(both.noise_groups == 2);
  for (std::size_t i = 0; i < longer->touches.touches.size(); ++i) {
    const int same = longer->same_as[i];
    CHECK(feature_of(*longer, i) == c.touches.features[c.touches.touches[same].scene.feature]);
    CHECK(both.noise_um(static_cast<Eigen::Index>(i)) == doctest::Approx(own.noise_um(same)));
    CHECK(both.noise_group[i] == own.noise_group[static_cast<std::size_t>(same)]);
  }
}

TEST_CASE("a part that is placed anew between the touches takes the operator's time too") {
  TouchedBlock block;
  const auto minutes = [&] { return minutes_of(*repeated(block.c, block.change("once more"))); };
  const double once = minutes();
  for (std::size_t i = block.c.touches.touches.size() / 2; i < block.c.touches.touches.size(); ++i)
    block.recording.rows[i].setup = 2;
  block.c.touches = recorded_touches(block.recording, block.machine, "");
  CHECK(minutes() - once == doctest::Approx(5).epsilon(0.1));
}

TEST_CASE("the tip stays before the surfaces and changes features above them") {
  const TouchedBlock block;
  const auto longer = repeated(block.c, block.change("once more"));
  REQUIRE(longer);
  const Path path = path_of(*longer);
  const auto& touches = longer->touches.touches;
  Vec3 at = path.steps[1].to;
  int above = 0;
  for (const Step& step : path.steps) {
    if (step.kind != Step::Kind::go) continue;
    for (int i = 0; i <= 20; ++i) {
      const Vec3 p = at + i / 20.0 * (step.to - at);
      const double from_bore = std::hypot(p.x - kBore.x, p.y - kBore.y), from_pin = std::hypot(p.x - 700, p.y - 500);
      const bool in_block = p.x > 490 - kTip_mm && p.y > 390 - kTip_mm && p.z < -600 + kTip_mm;
      // below the top only beside the block and inside the bore
      CHECK((!in_block || from_bore <= 10 - kTip_mm + 1e-6));
      CHECK((p.z > -580 + kTip_mm || from_pin >= 20 + kTip_mm));  // and not through the pin
    }
    if (step.to.z > -580 + 25) ++above;
    at = step.to;
  }
  CHECK(above >= 2 * 5);  // each of five features is entered from above and left upwards
  for (std::size_t k = longer->first; k < touches.size(); ++k)
    // to its middle
    if (feature_of(*longer, k) == "BORE") CHECK(path.free_mm[k - longer->first] == doctest::Approx(10 - kTip_mm));
}

TEST_CASE("a moved part is found by its own touches") {
  const TouchedBlock block;
  for (const char* how : {"turned by 90", "tilted by -20 degrees about X", "tilted by 20 degrees about Y"}) {
    INFO(how);
    const auto longer = repeated(block.c, block.change(how));
    REQUIRE(longer);
    const auto alignment = alignment_of(*longer);
    REQUIRE(alignment);
    // 3-2-1: the top is z = 0, the front y = 0, the left side x = 0, wherever the part stands.
    for (std::size_t k = longer->first; k < longer->touches.touches.size(); ++k) {
      const Vec3 p = alignment->X_DR * surface_of(*longer, k);
      if (feature_of(*longer, k) == "TOP") CHECK(std::abs(p.z) < 1e-9);
      if (feature_of(*longer, k) == "FRONT") CHECK(std::abs(p.y) < 1e-9);
      if (feature_of(*longer, k) == "LEFT") CHECK(std::abs(p.x) < 1e-9);
    }
  }
}

TEST_CASE("each name has a label that DMIS can hold, and no two the same") {
  using Names = std::vector<std::string>;
  CHECK(dmis_labels({"P1 1", "P1_1", "BORE", "P1/1", "P1_1_2"}) == Names{"P1_1_3", "P1_1", "BORE", "P1_1_4", "P1_1_2"});
}

TEST_CASE("what was touched becomes a feature of its kind") {
  const auto round = [](double radius_mm, std::initializer_list<double> heights) {
    Touched t;
    for (const double z : heights)
      for (int k = 0; k < 6; ++k) {
        const Vec3 out{0, std::cos(k * kPi / 3), std::sin(k * kPi / 3)};  // about X
        t.points.push_back(std::abs(radius_mm) * out + Vec3{z, 7, 9}), t.normals.push_back(radius_mm < 0 ? -out : out);
      }
    return t;
  };
  CHECK(dmis_feature(round(-10, {5})).definition ==
        "CIRCLE,INNER,CART,5.000000,7.000000,9.000000,1.000000000,0.000000000,0.000000000,20.0000000");
  CHECK(dmis_feature(round(10, {0, 10})).definition ==
        "CYLNDR,OUTER,CART,5.000000,7.000000,9.000000,1.000000000,0.000000000,0.000000000,20.0000000");
  CHECK(dmis_feature({{{1, 2, 3}}, {{0, 0, 1}}}).kind == "POINT");
  CHECK(dmis_feature({{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}}, {3, {0, 0, 1}}}).kind == "PLANE");
  CHECK(dmis_feature({{{0, 0, 0}, {9, 0, 0}, {5, 0, 0}}, {3, {0, 0, 1}}}).kind == "GSURF");  // on one line: no plane
  Touched ball;
  for (const Vec3& n : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}})
    ball.points.push_back(Vec3{1, 2, 3} + 15 * n), ball.normals.push_back(n);
  CHECK(dmis_feature(ball).definition == "SPHERE,OUTER,CART,1.000000,2.000000,3.000000,30.0000000");
}
