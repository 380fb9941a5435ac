#include "engine/run/recorded/from_program.hpp"
#include "engine/run/recorded/touch.hpp"

#include <doctest/doctest.h>

#include <functional>
#include <map>
#include <memory>

#include "engine/effects/effect.hpp"
#include "engine/machine/machine.hpp"

using namespace abbe;

namespace {

/// Eight touches of a ball whose surface seems `off_mm` too far out at each, with raw readings.
Recording ball(double off_mm) {
  Recording r;
  for (int k = 0; k < 8; ++k) {
    RecordingRow row;
    row.feature = "BALL", row.touch = k + 1;
    row.normal = Vec3{k & 1 ? 0.48 : -0.48, k & 2 ? 0.6 : -0.6, 0.64};
    row.target_mm = Vec3{800, 500, -600} + 14.5 * *row.normal;
    row.position_mm = *row.target_mm + off_mm * *row.normal;
    row.reading_mm = row.position_mm - Vec3{3, -2, 1};
    row.time_s = k;
    r.rows.push_back(row);
  }
  return r;
}

}  // namespace

TEST_CASE("only effects within a signal period see what a touch itself adds to its raw reading") {
  const Machine machine = read_machine("coord3-mc16");
  const RecordedTouches clean = recorded_touches(ball(0), machine, "clean"),
                        off = recorded_touches(ball(0.004), machine, "off");
  const Effect &scale = *find_effect("machine.scale"), &interpolation = *find_effect("machine.scale_interpolation");
  REQUIRE(off.touches.size() == 8);
  for (std::size_t i = 0; i < clean.touches.size(); ++i) {
    const RecordedTouch& t = off.touches[i];
    CHECK(norm(scene_for(scale, t).reading - scene_for(scale, clean.touches[i]).reading) < 1e-9);
    CHECK(norm(scene_for(interpolation, t).reading - scene_for(interpolation, clean.touches[i]).reading -
               0.004 * t.scene.normal) < 1e-9);
  }
}

TEST_CASE("the head was not indexed between two runs where the log goes on with the number of the visit") {
  const Machine machine = read_machine("coord3-mc16");
  // Of three runs of four touches each, with these numbers at the first two touches and at the others.
  const auto visits = [&](std::vector<std::pair<int, int>> logged, double tilted_deg = 0) {
    Recording r;
    for (int run = 1; run <= 3; ++run)
      for (int k = 0; k < 4; ++k) {
        RecordingRow row = ball(0).rows[static_cast<std::size_t>(k)];
        row.run = run, row.time_s = 100 * run + k;
        row.head_a_deg = run == 2 ? tilted_deg : 0, row.head_b_deg = 0;
        if (!logged.empty()) row.visit = k < 2 ? logged[run - 1].first : logged[run - 1].second;
        r.rows.push_back(row);
      }
    std::vector<int> out;
    for (const RecordedTouch& t : recorded_touches(r, machine, "r").touches)
      if (out.empty() || t.scene.visit != out.back()) out.push_back(t.scene.visit);
    return out;
  };
  CHECK(visits({{1, 1}, {1, 1}, {1, 1}}) == std::vector{0});
  CHECK(visits({{1, 1}, {1, 1}, {1, 1}}, 30) == std::vector{0, 1, 2});  // the head was turned, whatever the number says
  CHECK(visits({{1, 2}, {1, 2}, {1, 2}}) == std::vector{0, 1, 2, 3, 4, 5});  // each run counts its own
  CHECK(visits({{1, 2}, {2, 3}, {3, 3}}) == std::vector{0, 1, 2});
  CHECK(visits({{1, 1}, {2, 2}, {2, 2}}) == std::vector{0, 1});
  CHECK(visits({}) == std::vector{0, 1, 2});  // nobody knows
}

TEST_CASE("touches a hair beyond the travel stay where they are") {
  const Machine machine = read_machine("coord3-mc16");
  const auto highest = [&](double beyond_mm) {
    Recording r = ball(0);
    double top = -1e9;
    for (const RecordedTouch& t : recorded_touches(r, machine, "r").touches) top = std::max(top, t.scene.reading.z);
    for (RecordingRow& row : r.rows) row.target_mm->z += beyond_mm - top;
    return recorded_touches(r, machine, "r");
  };
  CHECK(highest(0.0003).messages.size() == highest(-1).messages.size());
  CHECK(highest(0.001).messages.back().code == Code::W0542);
}

TEST_CASE("copies of touches keep the names of their sensors") {
  auto touches = std::make_unique<RecordedTouches>(recorded_touches(ball(0), read_machine("coord3-mc16"), "r"));
  const RecordedTouches copy = *touches;
  touches.reset();
  for (const RecordedTouch& t : copy.touches) CHECK(t.scene.stylus.name.data() == copy.names->begin()->data());
}

TEST_CASE("a point of a surface is the same in every placement, though its targets are rounded") {
  Recording r = ball(0);
  const std::size_t once = r.rows.size();
  for (std::size_t k = 0; k < once; ++k) {
    RecordingRow row = r.rows[k];
    row.setup = 2, *row.time_s += 100;
    row.target_mm = *row.target_mm + Vec3{40, 25, 10} + 0.0006 * Vec3{k & 1 ? 1.0 : -1.0, 0, 0};
    r.rows.push_back(row);
  }
  const std::vector<int> points = surface_points(recorded_touches(r, read_machine("coord3-mc16"), "r"));
  for (std::size_t k = 0; k < once; ++k) {
    CHECK(points[k] == static_cast<int>(k % 4));  // each is touched twice
    CHECK(points[once + k] == points[k]);
  }
}

TEST_CASE("effects know which axis carries the part, and which lies along the bridge") {
  const auto first = [](const std::string& machine) {
    Recording r = ball(0);
    for (RecordingRow& row : r.rows) row.reading_mm = Vec3{300, 300, -300};
    return recorded_touches(r, read_machine(machine), "r").touches.front().scene;
  };
  const TouchScene portal = first("coord3-mc16"), table = first("moving-table-700"), along_y = first("precision-500");
  CHECK((portal.side[0] == 1 && portal.side[1] == 1 && portal.side[2] == 1));
  CHECK((portal.on_table == 0 && portal.on_bridge == 1));
  CHECK((table.side[0] == 1 && table.side[1] == -1 && table.side[2] == 1));
  CHECK((table.on_table == 1 && table.on_bridge == 0));
  CHECK((along_y.side[0] == 1 && along_y.side[1] == 1 && along_y.side[2] == 1));
  CHECK((along_y.on_table == 1 && along_y.on_bridge == 0));
}

TEST_CASE("two names are two names, even where their hashes are close") {
  // Of 4000 names some two agree in their hash modulo a million.
  std::map<std::size_t, std::string> met;
  std::pair<std::string, std::string> alike;
  for (int k = 0; k < 4000 && alike.first.empty(); ++k) {
    const std::string name = "F" + std::to_string(k);
    const auto [at, fresh] = met.emplace(std::hash<std::string>{}(name) % 1000003, name);
    if (!fresh) alike = {at->second, name};
  }
  REQUIRE_FALSE(alike.first.empty());
  Recording r = ball(0);
  for (std::size_t k = 0; k < r.rows.size(); ++k) r.rows[k].feature = k < 4 ? alike.first : alike.second;
  CHECK((recorded_touches(r, read_machine("coord3-mc16"), "r").varying & static_cast<unsigned>(Covariate::feature)) !=
        0);
}

TEST_CASE("targets of a program are of the point and in the frame that the recording states") {
  // One touch of a part that stands turned by a right angle about z, 0.01 mm too far out.
  MachineRecord program;
  RecordingRow aimed;
  aimed.feature = "FACE", aimed.normal = Vec3{0, 1, 0}, aimed.target_mm = Vec3{700, 402, -550},
  aimed.travel = Vec3{0, -1, 0};
  program.recording.rows = {aimed};
  const Rigid X_MD{rotation({0, 0, 1}, kPi / 2), {700, 400, -550}};
  program.aims = {{X_MD, 2.0}};
  for (const RecordedPoint point : {RecordedPoint::tip_centre, RecordedPoint::surface}) {
    for (const bool in_part : {false, true}) {
      Recording r;
      r.point = point, r.in_part_frame = in_part;
      const Vec3 measured{700, (point == RecordedPoint::surface ? 400 : 402) + 0.01, -550};
      RecordingRow row;
      row.feature = "Face", row.position_mm = in_part ? inverse(X_MD) * measured : measured;
      r.rows = {row};
      complete_from_program(r, program, "r");
      CHECK(r.rows[0].feature == "FACE");  // as the program has it
      CHECK_FALSE(r.in_part_frame);        // the program says where the part stands
      CHECK(norm(r.rows[0].position_mm - measured) < 1e-9);
      CHECK(norm(*r.rows[0].normal - Vec3{0, 1, 0}) < 1e-9);
      CHECK(dot(*r.rows[0].normal, r.rows[0].position_mm - *r.rows[0].target_mm) == doctest::Approx(0.01));
      CHECK(norm(*r.rows[0].on_part_mm) < 1e-9);  // the origin of the program's coordinate system
      CHECK(norm(*r.rows[0].normal_on_part - Vec3{1, 0, 0}) < 1e-9);
    }
  }
}

TEST_CASE("the travel of a program turns with targets that the file gives, and its targets are known to be planned") {
  MachineRecord program;
  Recording turned;
  const Mat3 R = rotation({0, 0, 1}, kPi / 2);
  for (int k = 0; k < 3; ++k) {
    RecordingRow aimed;
    aimed.feature = "FACE", aimed.touch = k + 1, aimed.normal = Vec3{0, 1, 0}, aimed.travel = Vec3{0, -1, 0};
    aimed.target_mm = Vec3{700 + 20.0 * k, 402, k == 2 ? -550.0 : -500.0};
    program.recording.rows.push_back(aimed);
    program.aims.push_back({Rigid{}, 2.0});
    aimed.target_mm = R * *aimed.target_mm, aimed.normal = R * *aimed.normal, aimed.travel.reset();
    aimed.position_mm = *aimed.target_mm;
    turned.rows.push_back(aimed);
  }
  Recording bare = turned;
  complete_from_program(turned, program, "turned");
  for (RecordingRow& row : bare.rows) row.target_mm.reset(), row.normal.reset();
  complete_from_program(bare, program, "bare");
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(norm(*turned.rows[k].travel - Vec3{1, 0, 0}) < 1e-9);
    CHECK_FALSE(turned.rows[k].target_as_planned);
    CHECK(*bare.rows[k].travel == Vec3{0, -1, 0});
    CHECK(bare.rows[k].target_as_planned);
  }
}

TEST_CASE(
    "the head stands as its stylus says where no column tells it, and as nothing says where the stylus is assumed") {
  Machine machine = read_machine("coord3-mc16");
  for (const auto& [name, a_rad] : {std::pair{"DOWN", 0.0}, {"SIDE", kPi / 2}})
    machine.sensors[name] = {.head_a_rad = a_rad,
                             .tip_in_r_mm = {0, 0, -100},
                             .radius_mm = 2,
                             .material = "",
                             .young_GPa = 600,
                             .cte_ppm_per_K = 5};
  const unsigned head = static_cast<unsigned>(Covariate::head);
  Recording r = ball(0);
  const RecordedTouches assumed = recorded_touches(r, machine, "assumed");
  CHECK((assumed.known & head) == 0);
  for (RecordingRow& row : r.rows) row.sensor = "DOWN";
  const RecordedTouches one = recorded_touches(r, machine, "one");
  CHECK((one.known & head) != 0);
  CHECK((one.varying & head) == 0);
  r.rows.back().sensor = "SIDE";
  CHECK((recorded_touches(r, machine, "two").varying & head) != 0);
}
