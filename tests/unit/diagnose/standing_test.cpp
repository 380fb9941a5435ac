#include "engine/diagnose/baseline/standing.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <utility>

#include "engine/diagnose/baseline/round_surface.hpp"
#include "engine/math/vec.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

constexpr double kPlaced_mm = 2e-4;  // what is left of a placement is taken up by the linear model
constexpr double kNoTip = 1e9;       // mm: the tip is not asked about
constexpr double kError_mm = 0.004;  // of the sixth touch on each side of the box

/// Nine touches on each of the six sides of a box, each with a small error, seen where the part stands with X.
Recording box(const Rigid& X, int setup = 1) {
  Recording r;
  for (int side = 0; side < 6; ++side) {
    for (int k = 0; k < 9; ++k) {
      RecordingRow row;
      row.feature = "SIDE", row.touch = 9 * side + k + 1, row.setup = setup;
      Vec3 n, along;
      const int axis = side / 2;
      n[axis] = side % 2 ? 1 : -1;
      along[(axis + 1) % 3] = 40.0 * (k % 3 - 1), along[(axis + 2) % 3] = 30.0 * (k / 3 - 1);
      row.normal = n, row.target_mm = Vec3{400, 300, -200} + 60.0 * n + along;
      row.position_mm = X * (*row.target_mm + (k == 5 ? kError_mm : 0) * n);
      r.rows.push_back(row);
    }
  }
  return r;
}

/// A spiral from the pole of a ball to its equator, each touch with a small error.
Recording ball() {
  const Vec3 middle{400, 300, -200};
  Recording r;
  for (int k = 0; k < 25; ++k) {
    const double height = 1 - k / 24.0, across = std::sqrt(1 - height * height);
    RecordingRow row;
    row.feature = "BALL", row.touch = k + 1, row.setup = 1;
    row.normal = Vec3{across * std::cos(2.4 * k), across * std::sin(2.4 * k), height};
    row.target_mm = middle + 14.5 * *row.normal;
    row.position_mm = *row.target_mm + 0.001 * std::sin(5.0 * k) * *row.normal;
    r.rows.push_back(row);
  }
  return r;
}

double off_mm(const RecordingRow& row) { return dot(*row.normal, row.position_mm - *row.target_mm); }

}  // namespace

TEST_CASE("a part that stood off its targets is carried back, and its errors stay") {
  const Rigid placements[] = {{Mat3{}, {0.3, 0, 0}},
                              {rotation(unit({1, 2, 2}), 0.02), {1, -2, 0.5}},
                              {rotation({0, 0, 1}, 0.5), {120, 30, -80}}};
  for (const Rigid& X : placements) {
    Recording recorded = box(X);
    recorded.rows[3].position_mm += 5.0 * (X.R * *recorded.rows[3].normal);  // a gross error turns nothing
    std::vector<Diagnostic> messages;
    const Recording back = put_on_targets(recorded, kNoTip, "box", messages);
    REQUIRE(messages.size() == 1);
    CHECK(messages[0].code == Code::N0709);
    for (std::size_t i = 0; i < back.rows.size(); ++i) {
      if (i == 3) continue;
      CHECK(std::abs(off_mm(back.rows[i]) - (i % 9 == 5 ? kError_mm : 0)) < kPlaced_mm);
    }
  }
}

TEST_CASE("targets that only the program tells are carried to where the part stood") {
  const Rigid X{rotation({0, 0, 1}, kPi / 2), {120, 30, -80}};
  Recording recorded = box(X);
  for (RecordingRow& row : recorded.rows) {
    row.travel = -*row.normal;
    row.target_as_planned = row.travel_as_planned = true;
  }
  std::vector<Diagnostic> messages;
  const Recording there = put_on_targets(recorded, kNoTip, "box", messages);
  REQUIRE(messages.size() == 1);
  CHECK(messages[0].code == Code::N0709);
  CHECK(messages[0].message.find("turned by 90.000 degrees; its targets are carried there") != std::string::npos);
  for (std::size_t i = 0; i < there.rows.size(); ++i) {
    const RecordingRow &row = there.rows[i], &before = recorded.rows[i];
    CHECK(norm(row.position_mm - before.position_mm) < 1e-9);  // the machine measured there
    CHECK(norm(*row.normal - X.R * *before.normal) < 1e-5);
    CHECK(norm(*row.travel + *row.normal) < 1e-12);
    CHECK(std::abs(off_mm(row) - (i % 9 == 5 ? kError_mm : 0)) < kPlaced_mm);
  }
  recorded.rows[7].target_as_planned = false;  // the file has a target of its own: all lie where that does
  CHECK(norm(put_on_targets(recorded, kNoTip, "box", messages).rows[0].position_mm - *recorded.rows[0].target_mm) <
        0.01);
}

TEST_CASE("rows in micrometres turn no part, wherever it stood") {
  constexpr double kUmPerMm = 1000;
  constexpr double kManyPlaced_mm =
      5e-3;  // so many are refused: it only matters that they are told by their own distance
  const Rigid placements[] = {{Mat3{}, {}}, {Mat3{}, {0.3, 0, 0}}, {rotation(unit({1, 2, 2}), 0.5), {120, 30, -80}}};
  for (const Rigid& X : placements) {
    for (const auto& [every, placed_mm] : {std::pair(54, kPlaced_mm), {18, kPlaced_mm}, {4, kManyPlaced_mm}}) {
      Recording recorded = box(X);
      const auto in_um = [every = every](std::size_t i) { return static_cast<int>(i) % every == 3; };
      for (std::size_t i = 0; i < recorded.rows.size(); ++i)
        if (in_um(i)) recorded.rows[i].position_mm *= kUmPerMm;
      std::vector<Diagnostic> messages;
      const Recording back = put_on_targets(recorded, kNoTip, "box", messages);
      CHECK(messages.size() == (X.p == Vec3{} ? 0 : 1));
      for (std::size_t i = 0; i < back.rows.size(); ++i)
        if (!in_um(i)) CHECK(std::abs(off_mm(back.rows[i]) - (i % 9 == 5 ? kError_mm : 0)) < placed_mm);
    }
  }
}

TEST_CASE("a part on its targets is left as it is, and so is a turn that nothing shows") {
  std::vector<Diagnostic> messages;
  const Recording recorded = box({Mat3{}, {0.02, 0, 0}}), same = put_on_targets(recorded, kNoTip, "box", messages);
  CHECK(messages.empty());
  for (std::size_t i = 0; i < recorded.rows.size(); ++i)
    CHECK(same.rows[i].position_mm == recorded.rows[i].position_mm);

  Recording face;  // one plane: shifts in it and the turn about its normal are free
  for (const RecordingRow& row : box({Mat3{}, {0, 0, 2}}).rows)
    if (row.normal->z > 0.5) face.rows.push_back(row);
  const Recording back = put_on_targets(face, kNoTip, "face", messages);
  REQUIRE(messages.size() == 1);
  for (std::size_t i = 0; i < face.rows.size(); ++i) {
    CHECK(std::abs(off_mm(back.rows[i])) < 0.01);
    CHECK(std::hypot(back.rows[i].position_mm.x - face.rows[i].position_mm.x,
                     back.rows[i].position_mm.y - face.rows[i].position_mm.y) < 0.01);
  }
}

TEST_CASE("one touch far off along the surface turns no ball") {
  Recording strayed = ball();
  strayed.rows[8].position_mm.x += 30;
  std::vector<Diagnostic> messages;
  const Recording same = put_on_targets(strayed, kNoTip, "ball", messages);
  CHECK(messages.empty());
  for (std::size_t i = 0; i < strayed.rows.size(); ++i) CHECK(same.rows[i].position_mm == strayed.rows[i].position_mm);
}

TEST_CASE("a ball that was shifted is not turned") {
  const Recording here = ball();
  Recording shifted = here;
  for (RecordingRow& row : shifted.rows) row.position_mm += Vec3{1.5, -1, 0.5};
  std::vector<Diagnostic> messages;
  const Recording back = put_on_targets(shifted, kNoTip, "ball", messages);
  REQUIRE(messages.size() == 1);
  for (std::size_t i = 0; i < here.rows.size(); ++i)
    CHECK(norm(back.rows[i].position_mm - here.rows[i].position_mm) < 0.002);  // as large as the errors
}

TEST_CASE("a round surface that stands elsewhere is touched elsewhere") {
  // The machine goes along the normals of the targets until it touches the ball where it stands.
  const Vec3 middle{400, 300, -200}, shift{0.3, -0.5, 0.4};
  Recording here = ball();
  std::vector<double> error_mm;
  for (RecordingRow& row : here.rows) {
    error_mm.push_back(off_mm(row));
    const Vec3 from =
        *row.target_mm - middle - shift;  // along n until the distance from the new middle is that of the ball
    const double along = dot(*row.normal, from), radius = 14.5 + error_mm.back();
    const double t = -along + std::sqrt(along * along - dot(from, from) + radius * radius);
    row.position_mm = *row.target_mm + t * *row.normal;
  }
  for (const bool points : {false, true}) {
    if (points)
      for (RecordingRow& row : here.rows) row.feature += std::to_string(std::exchange(row.touch, 1));
    std::vector<Diagnostic> messages;
    const Recording back = put_on_targets(here, kNoTip, "ball", messages);
    REQUIRE(messages.size() == 1);
    for (std::size_t i = 0; i < here.rows.size(); ++i) CHECK(std::abs(off_mm(back.rows[i]) - error_mm[i]) < 8e-4);
  }
}

TEST_CASE("balls and cylinders are known from their targets, a box is none") {
  std::vector<Vec3> targets, normals, sides, faces;
  for (const RecordingRow& row : box({}).rows) sides.push_back(*row.target_mm), faces.push_back(*row.normal);
  CHECK(!RoundSurface::through(sides, faces));
  const std::vector<Vec3> centre(6);  // three coordinates of it, twice
  CHECK(!RoundSurface::through(centre, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  for (const double radius : {20.0, -20.0}) {
    targets.clear(), normals.clear();
    for (int k = 0; k < 12; ++k) {
      normals.push_back({std::cos(kPi / 6 * k), std::sin(kPi / 6 * k), 0});
      targets.push_back(Vec3{5, 6, 3.0 * (k % 3)} + radius * normals.back());
    }
    const auto cylinder = RoundSurface::through(targets, normals);
    REQUIRE(cylinder);
    const Vec3 beside = targets[0] + Vec3{0, 1, 7};  // one across, and any along the axis
    CHECK(cylinder->bend_mm(targets[0], beside) == doctest::Approx(std::copysign(std::hypot(20, 1) - 20, radius)));
    CHECK(cylinder->bend_mm(targets[0], targets[0] + Vec3{0, 6, 0}) == 0);
  }
}

TEST_CASE("the approaches of a part that stood turned are turned back with it") {
  const Rigid X{rotation({0, 0, 1}, kPi), {900, 700, 0}};
  Recording turned = box(X);
  for (RecordingRow& row : turned.rows) row.travel = -(X.R * *row.normal);
  std::vector<Diagnostic> messages;
  const Recording back = put_on_targets(turned, kNoTip, "turned", messages);
  for (const RecordingRow& row : back.rows) CHECK(norm(*row.travel + *row.normal) < 1e-6);
  for (RecordingRow& row : turned.rows) row.travel = -*row.travel;
  CHECK_THROWS_AS(put_on_targets(turned, kNoTip, "turned", messages), UserError);
}

TEST_CASE("each setup has its own placement") {
  Recording both = box({Mat3{}, {1, 0, 0}}, 1);
  const Recording second = box({Mat3{}, {0, -3, 0}}, 2);
  both.rows.insert(both.rows.end(), second.rows.begin(), second.rows.end());
  std::vector<Diagnostic> messages;
  for (const RecordingRow& row : put_on_targets(both, kNoTip, "both", messages).rows)
    CHECK(std::abs(off_mm(row)) < 1.1 * kError_mm);
  CHECK(messages.size() == 2);
}

TEST_CASE("a wrong tip is told from a part off its targets") {
  Recording recorded = box({rotation({0, 0, 1}, 0.1), {5, 0, 0}});
  for (RecordingRow& row : recorded.rows) row.position_mm += 0.1 * (rotation({0, 0, 1}, 0.1) * *row.normal);
  std::vector<Diagnostic> messages;
  try {
    put_on_targets(recorded, 0.05, "box", messages);
    FAIL("a wrong tip was taken for a placement");
  } catch (const UserError& error) {
    CHECK(error.diagnostics()[0].code == Code::E0701);
    CHECK(error.diagnostics()[0].message.find("0.100 mm too far out") != std::string::npos);
  }
  CHECK_NOTHROW(put_on_targets(recorded, 0.2, "box", messages));
}

TEST_CASE("a ring with a wrong tip is not turned about its axis until it fits") {
  // With 4 mm too little of 23 the tip's circle passes for one that is seen turned by 31.6 degrees: cos 31.6 = 23 / 27.
  for (const double off : {-4.0, -1.0, 1.0}) {
    Recording recorded;
    for (int k = 0; k < 36; ++k) {
      RecordingRow row;
      const double angle = kPi / 6 * k;
      row.feature = "RING", row.touch = k + 1;
      row.normal = Vec3{-std::cos(angle), -std::sin(angle), 0};
      row.target_mm = Vec3{800, 500, -650.0 + 10 * (k / 12)} - 23.0 * *row.normal;
      row.position_mm = *row.target_mm + (off + 1e-3 * std::sin(3.0 * angle + k)) * *row.normal;
      recorded.rows.push_back(row);
    }
    std::vector<Diagnostic> messages;
    CHECK_THROWS_AS(put_on_targets(recorded, 0.05, "ring", messages), UserError);
    CHECK_NOTHROW(put_on_targets(recorded, kNoTip, "ring", messages));
  }
}
