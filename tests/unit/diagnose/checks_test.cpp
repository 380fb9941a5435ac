#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "engine/diagnose/checks/clock.hpp"
#include "engine/diagnose/checks/data_problems.hpp"
#include "engine/diagnose/checks/logged_columns.hpp"
#include "engine/diagnose/checks/normals.hpp"
#include "engine/diagnose/checks/pairing.hpp"
#include "engine/diagnose/checks/repeats.hpp"
#include "engine/diagnose/checks/scale_readings.hpp"
#include "engine/diagnose/checks/unlogged_styli.hpp"
#include "engine/math/units.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

/// Three balls, six touches on each, with all that a controller can log; positions some um beside their targets.
Recording of_three_balls() {
  constexpr double kRadius_mm = 12.5, kTip_mm = 2;
  const Vec3 centres[] = {{310, 220, -410}, {760, 340, -455}, {480, 610, -500}};
  const Vec3 sides[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, unit({1, 1, 1})};
  Recording r;
  for (int ball = 0; ball < 3; ++ball)
    for (int k = 0; k < 6; ++k) {
      RecordingRow row;
      const int i = static_cast<int>(r.rows.size());
      row.feature = "BALL" + std::to_string(ball + 1);
      row.touch = k + 1;
      row.normal = sides[k];
      row.target_mm = centres[ball] + (kRadius_mm + kTip_mm) * sides[k];
      row.position_mm = *row.target_mm + 0.001 * std::sin(3.0 * i + 1) * Vec3{1, 0.7, -0.4};
      row.reading_mm = row.position_mm + Vec3{-40.123, 65.25, 180.5};
      row.travel = -sides[k];
      row.sensor = "S1";
      row.head_a_deg = 45, row.head_b_deg = -90;
      row.time_s = 100 + 5.0 * i;
      row.speed_mm_s = 5, row.accel_mm_s2 = 400;
      row.temp_part_C = 20.4, row.temp_air_C = 21;
      row.line = i + 2;
      r.rows.push_back(row);
    }
  return r;
}

/// What somebody did to a file.
using Damage = std::function<void(RecordingRow&)>;
Recording damaged(const Damage& damage) {
  Recording r = of_three_balls();
  for (RecordingRow& row : r.rows) damage(row);
  return r;
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The message with which a file is refused; of no code where it is not.
Diagnostic refusal(const std::function<void()>& check) {
  try {
    check();
  } catch (const UserError& e) {
    return e.diagnostics().front();
  }
  return {};
}
Diagnostic refusal(const Recording& r) {
  const Machine machine = read_machine("coord3-mc16");
  return refusal([&] { check_data(r, machine, "r.csv"); });
}

using Check = void (*)(Recording&, const std::string&, std::vector<Diagnostic>&);
std::vector<Diagnostic> said_by(Check check, Recording& r) {
  std::vector<Diagnostic> messages;
  check(r, "r.csv", messages);
  return messages;
}

}  // namespace

TEST_CASE("a file without mistakes is as it was") {
  Recording r = of_three_balls();
  CHECK_NOTHROW(check_data(r, read_machine("coord3-mc16"), "r.csv"));
  std::vector<Diagnostic> messages;
  CHECK(without_copies(r, "r.csv", messages).rows.size() == r.rows.size());
  for (const Check check :
       {continue_past_midnight, continue_where_put_back, count_from_first_touch, leave_out_partly_logged,
        leave_out_readings_without_phase, leave_out_commanded_readings, leave_out_constant_travel, leave_out_astray})
    check(r, "r.csv", messages);
  doubt_temperatures(r, "r.csv", messages);
  doubt_motion(r, "r.csv", messages);
  CHECK(!styli_unlogged(r, "r.csv", messages));
  CHECK(messages.empty());
  const Recording before = of_three_balls();
  CHECK(to_csv(r) == to_csv(before));
}

TEST_CASE("files that no physics explains are refused with what mends them") {
  struct Mistake {
    Damage made;
    const char *told, *remedy;
  };
  const Mistake mistakes[] = {
      {[](RecordingRow& row) { row.position_mm = row.position_mm / 1000; }, "recorded positions are in metres",
       "multiply x, y, z by 1000"},
      {[](RecordingRow& row) { row.position_mm = row.position_mm / kMmPerInch; }, "recorded positions are in inches",
       "by 25.4"},
      {[](RecordingRow& row) { row.target_mm = *row.target_mm / 1000, row.reading_mm.reset(); },
       "the targets are in metres", "multiply tx, ty, tz by 1000"},
      {[](RecordingRow& row) { row.position_mm.y /= 1000; }, "y of the recorded positions is in metres",
       "multiply y by 1000"},
      {[](RecordingRow& row) { row.position_mm.z = -400; }, "z of the recorded positions is the same in all rows",
       "write the position of each touch"},
      {[](RecordingRow& row) { std::swap(row.position_mm.x, row.position_mm.y); }, "axes of the recorded positions",
       "x, y, z as they are now y, x, z"},
      {[](RecordingRow& row) { row.position_mm.z = -row.position_mm.z; }, "the sign of z is turned round",
       "correct the sign"},
      {[](RecordingRow& row) { row.normal->x = -row.normal->x; }, "the sign of nx is turned round", "correct the sign"},
      {[](RecordingRow& row) {
         row.normal = Vec3{row.normal->y, row.normal->z, row.normal->x};
       },
       "axes of the normals are swapped", "nx, ny, nz as they are now nz, nx, ny"},
      {[](RecordingRow& row) { row.head_a_deg = kPi / 4, row.head_b_deg = -kPi / 2; }, "head are in radians",
       "57.29578"},
      {[](RecordingRow& row) { row.reading_mm = 1000.0 * *row.reading_mm; }, "scale readings are in micrometres",
       "by 0.001"},
      {[](RecordingRow& row) { row.reading_mm->y /= 1000; }, "enc_y is in metres", "multiply enc_y by 1000"},
      {[](RecordingRow& row) { row.reading_mm->x = -row.reading_mm->x; }, "the sign of enc_x", "correct the sign"},
      {[](RecordingRow& row) { std::swap(row.reading_mm->x, row.reading_mm->z); }, "axes of the scale readings",
       "enc_z, enc_y, enc_x"},
  };
  for (const Mistake& m : mistakes) {
    CAPTURE(m.told);
    const Diagnostic d = refusal(damaged(m.made));
    CHECK(d.code == Code::E0701);
    CHECK(holds(d.message, "r.csv"));
    CHECK(holds(d.message, m.told));
    CHECK(holds(d.help, m.remedy));
  }
}

TEST_CASE("a part in its own coordinates may be small, but not as small as one in metres") {
  Recording small = of_three_balls();
  small.in_part_frame = true;
  for (RecordingRow& row : small.rows) {
    const Vec3 deviation = row.position_mm - *row.target_mm;
    row.target_mm = 0.8 * *row.normal;
    row.position_mm = *row.target_mm + deviation;
    row.reading_mm.reset();
  }
  CHECK_NOTHROW(check_data(small, read_machine("coord3-mc16"), "r.csv"));
  for (RecordingRow& row : small.rows) row.target_mm = *row.target_mm / 20, row.position_mm = row.position_mm / 20;
  CHECK(holds(refusal([&] { check_data(small, read_machine("coord3-mc16"), "r.csv"); }).message, "are in metres"));
}

TEST_CASE("copies of a row count once, and one touch has one value") {
  Recording r = of_three_balls();
  r.rows.push_back(r.rows[4]);
  std::vector<Diagnostic> messages;
  CHECK(without_copies(r, "r.csv", messages).rows.size() == r.rows.size() - 1);
  REQUIRE(messages.size() == 1);
  CHECK(messages[0].code == Code::W0702);
  r.rows.back().position_mm.x += 0.01;
  CHECK(refusal([&] { without_copies(r, "r.csv", messages); }).code == Code::E0713);
  r.rows.back().run = 2;  // a repeat
  CHECK(without_copies(r, "r.csv", messages).rows.size() == r.rows.size());
}

TEST_CASE("clocks of the day count from the first touch, and on past midnight") {
  constexpr double kNoon_s = 43200, kDay_s = 86400;
  Recording late = damaged([](RecordingRow& row) { *row.time_s += kNoon_s; });
  const auto note = said_by(count_from_first_touch, late);
  REQUIRE(note.size() == 1);
  CHECK(note[0].code == Code::N0721);
  CHECK(*late.rows.front().time_s == 0);
  CHECK(*late.rows.back().time_s == doctest::Approx(85));

  Recording night = damaged([](RecordingRow& row) { *row.time_s = std::fmod(*row.time_s + kDay_s - 150, kDay_s); });
  const auto fall = said_by(continue_past_midnight, night);
  REQUIRE(fall.size() == 1);
  CHECK(fall[0].code == Code::N0727);
  CHECK(holds(fall[0].message, "falls from 86395 s to 0 s"));
  for (std::size_t i = 1; i < night.rows.size(); ++i)
    CHECK(*night.rows[i].time_s - *night.rows[i - 1].time_s == doctest::Approx(5));
}

TEST_CASE("clocks that are set anew for each run go on from one to the next") {
  const auto runs = [](int count, double begin_s) {
    Recording all;
    for (int run = 1; run <= count; ++run) {
      Recording one = of_three_balls();
      for (RecordingRow& row : one.rows) row.run = run, *row.time_s += begin_s * (run - 1), all.rows.push_back(row);
    }
    return all;
  };
  Recording anew = runs(3, 0);
  const auto said = said_by(continue_from_run_to_run, anew);
  REQUIRE(said.size() == 1);
  CHECK(said[0].code == Code::N0708);
  CHECK(holds(said[0].message, "at the beginning of 2 of 3 runs"));
  for (std::size_t i = 1; i < anew.rows.size(); ++i) {
    const double step_s = *anew.rows[i].time_s - *anew.rows[i - 1].time_s;
    CHECK(step_s == doctest::Approx(anew.rows[i].run == anew.rows[i - 1].run ? 5 : 60));
  }
  Recording rising = runs(3, 1000), falling = runs(3, -1000), mixed = runs(2, 0);
  std::stable_sort(mixed.rows.begin(), mixed.rows.end(),
                   [](const RecordingRow& a, const RecordingRow& b) { return *a.time_s < *b.time_s; });
  Recording in_a_pause = runs(3, 0);
  for (RecordingRow& row : in_a_pause.rows) *row.time_s += row.run == 1 ? 2000 : row.run == 2 ? 0 : 1000;
  for (Recording* r : {&rising, &falling, &mixed, &in_a_pause}) CHECK(said_by(continue_from_run_to_run, *r).empty());
}

TEST_CASE("clocks that are put back within a run go on") {
  constexpr double kHour_s = 3600, kDay_s = 86400;
  const auto set_by = [](double begin_s, double last_s, double by_s) {
    return damaged([=](RecordingRow& row) {
      *row.time_s += begin_s;
      if (*row.time_s > last_s) *row.time_s -= by_s;
    });
  };
  for (const double by_s : {kHour_s, 12 * kHour_s}) {
    Recording back = set_by(13 * kHour_s - 152, 13 * kHour_s, by_s);
    const auto fall = said_by(continue_where_put_back, back);
    REQUIRE(fall.size() == 1);
    CHECK(fall[0].code == Code::N0734);
    for (std::size_t i = 1; i < back.rows.size(); ++i)
      CHECK(*back.rows[i].time_s - *back.rows[i - 1].time_s == doctest::Approx(5));
  }
  Recording other = set_by(13 * kHour_s - 152, 13 * kHour_s, kHour_s / 2), night = set_by(kDay_s - 152, kDay_s, kDay_s),
            again = set_by(13 * kHour_s - 152, 13 * kHour_s, kHour_s),
            slow = set_by(13 * kHour_s - 152, 13 * kHour_s, kHour_s - 6),
            ahead = damaged([](RecordingRow&row) { *row.time_s += row.line == 9 ? 3000 : 0; });  // one wrong time
  for (RecordingRow& row : again.rows)
    if (*row.time_s < 13 * kHour_s - 152) row.run = 2;  // a new run may begin at any time
  for (Recording* r : {&other, &night, &again, &slow, &ahead}) CHECK(said_by(continue_where_put_back, *r).empty());
}

TEST_CASE("a run whose touches are all there again is two runs") {
  const auto again = [](int times, std::size_t of_last) {
    Recording all;
    for (int k = 0; k < times; ++k)
      for (const RecordingRow& row : of_three_balls().rows) {
        if (k + 1 == times && all.rows.size() >= 18 * std::size_t(k) + of_last) break;
        all.rows.push_back(row), all.rows.back().run = 2, *all.rows.back().time_s += 1000 * k;
      }
    return all;
  };
  Recording twice = again(2, 18), cut_off = again(3, 4);
  for (Recording* r : {&twice, &cut_off}) {
    const auto told = said_by(number_repeats, *r);
    REQUIRE(told.size() == 1);
    CHECK(told[0].code == Code::N0708);
    CHECK(holds(told[0].message,
                r == &twice
                    ? "run 2 holds the same touches twice, in the same order; the second time counts as run 3"
                    : "run 2 holds the same touches 3 times, in the same order; the later ones count as runs 3, 4"));
    for (std::size_t i = 0; i < r->rows.size(); ++i) CHECK(r->rows[i].run == 2 + int(i / 18));
  }
  // The runs after it count on, each of several setups has its own, and a ball that is looked at again is no repeat.
  Recording two = again(2, 18), setups = again(2, 18), looked_at = again(2, 6), balls;
  for (RecordingRow row : of_three_balls().rows) row.run = 3, two.rows.push_back(row);
  for (RecordingRow row : again(2, 18).rows) row.setup = 2, setups.rows.push_back(row);
  CHECK(said_by(number_repeats, two).size() == 1);
  CHECK(two.rows.back().run == 4);
  CHECK(said_by(number_repeats, setups).size() == 1);
  CHECK(setups.rows.back().run == 3);
  for (const RecordingRow& row : looked_at.rows) balls.rows.push_back(row);
  std::rotate(balls.rows.begin() + 6, balls.rows.begin() + 18, balls.rows.end());  // the first ball between the others
  Recording numbered = of_three_balls();
  for (Recording* r : {&looked_at, &balls, &numbered}) CHECK(said_by(number_repeats, *r).empty());
  // Without a time the positions tell a repeat from rows that were copied.
  Recording copied = again(2, 18), anew = again(2, 18);
  for (Recording* r : {&copied, &anew})
    for (RecordingRow& row : r->rows) row.time_s.reset();
  for (std::size_t i = 18; i < anew.rows.size(); ++i) anew.rows[i].position_mm.x += 1e-4 * double(i % 3);
  CHECK(said_by(number_repeats, copied).empty());
  CHECK(said_by(number_repeats, anew).size() == 1);
  Recording at_one_time = again(2, 18);
  for (std::size_t i = 18; i < 36; ++i)
    at_one_time.rows[i].time_s = at_one_time.rows[i - 18].time_s, at_one_time.rows[i].position_mm.x += 1e-4;
  CHECK(said_by(number_repeats, at_one_time).empty());
}

TEST_CASE("runs that are numbered against the clock are told") {
  const auto said = [](const std::vector<int>& order, double each_s, bool timed = true) {
    Recording all;
    for (std::size_t k = 0; k < order.size(); ++k)
      for (RecordingRow row : of_three_balls().rows)
        row.run = order[k], *row.time_s += each_s * double(k), all.rows.push_back(row);
    if (!timed) all.rows.back().time_s.reset();
    const Check doubts = [](Recording& r, const std::string& file, std::vector<Diagnostic>& messages) {
      doubt_run_numbers(r, file, messages);
    };
    return said_by(doubts, all);
  };
  const auto told = said({3, 1, 7}, 1000);
  REQUIRE(told.size() == 1);
  CHECK(told[0].code == Code::N0708);
  CHECK(holds(told[0].message, "by the clock its runs were made in the order 3, 1, 7; what is new in a run"));
  CHECK(said({1, 3, 7}, 1000).empty());
  CHECK(said({2, 1}, 50).empty());  // at the same time, as of two placements
  CHECK(said({2, 1}, 1000, false).empty());
}

TEST_CASE("a clock that stands still is not used, and one that falls back once is doubted") {
  Recording still = damaged([](RecordingRow& row) { row.time_s = 7; });
  const auto told = said_by(leave_out_clock_at_rest, still);
  REQUIRE(told.size() == 1);
  CHECK(told[0].code == Code::W0738);
  for (const RecordingRow& row : still.rows) CHECK(!row.time_s);
  Recording runs = of_three_balls();
  CHECK(said_by(leave_out_clock_at_rest, runs).empty());
  Recording two = damaged(
      [](RecordingRow& row) { row.file = row.line > 10 ? 1 : 0, row.time_s = row.file == 1 ? 40 : *row.time_s; });
  two.files = {"a.csv", "b.csv"};
  const auto of_one = said_by(leave_out_clock_at_rest, two);
  REQUIRE(of_one.size() == 1);
  CHECK(holds(of_one[0].message, "b.csv: its clock stands at 40 s"));

  const Check doubts = [](Recording& r, const std::string& file, std::vector<Diagnostic>& messages) {
    doubt_fall(r, file, messages);
  };
  CHECK(said_by(doubts, runs).empty());
  Recording one_wrong = runs, mixed = runs;
  one_wrong.rows[7].time_s = 1;
  const auto fall = said_by(doubts, one_wrong);
  REQUIRE(fall.size() == 1);
  CHECK(fall[0].code == Code::W0728);
  CHECK(holds(fall[0].message, "falls from 130 s to 1 s before 'BALL2' touch 2"));
  std::swap(mixed.rows[3], mixed.rows[9]), std::swap(mixed.rows[5], mixed.rows[14]);
  CHECK(said_by(doubts, mixed).empty());
}

TEST_CASE("columns with gaps or of another unit are told") {
  Recording gaps = of_three_balls();
  gaps.rows[3].temp_part_C.reset();
  const auto left_out = said_by(leave_out_partly_logged, gaps);
  REQUIRE(left_out.size() == 1);
  CHECK(left_out[0].code == Code::W0722);
  CHECK(holds(left_out[0].message, "temp_part_C is empty in 1 of 18 rows"));
  for (const RecordingRow& row : gaps.rows) CHECK((!row.temp_part_C && row.temp_air_C));

  Recording two = of_three_balls();
  two.files = {"a.csv", "b.csv"};
  for (std::size_t k = 9; k < 18; ++k) two.rows[k].file = 1, two.rows[k].temp_part_C.reset();
  two.rows[4].temp_air_C.reset();
  const auto by_file = said_by(leave_out_partly_logged, two);
  REQUIRE(by_file.size() == 2);
  CHECK(holds(by_file[0].message, "b.csv: temp_part_C is in no row, only in other files"));
  CHECK(!holds(by_file[0].message, "a.csv"));
  CHECK(!holds(by_file[0].help, "leave those rows out"));
  CHECK(holds(by_file[1].message, "a.csv: temp_air_C is empty in 1 of 9 rows"));
  CHECK(!holds(by_file[1].message, "b.csv"));

  std::vector<Diagnostic> messages;
  doubt_temperatures(damaged([](RecordingRow& row) { row.temp_part_C = 68.7; }), "r.csv", messages);
  REQUIRE(messages.size() == 1);
  CHECK(messages[0].code == Code::W0724);
  CHECK(holds(messages[0].help, "68.7 F are 20.4 C"));

  messages.clear();
  doubt_temperatures(damaged([](RecordingRow& row) { row.temp_part_C = 293.4; }), "r.csv", messages);
  REQUIRE(messages.size() == 1);
  CHECK(holds(messages[0].help, "293.4 K are 20.2 C"));

  messages.clear();
  doubt_motion(damaged([](RecordingRow& row) {
                 row.speed_mm_s = 300, row.accel_mm_s2 = 0.4;
                 *row.time_s *= 1000;
               }),
               "r.csv", messages);
  REQUIRE(messages.size() == 3);
  for (const Diagnostic& d : messages) CHECK(d.code == Code::W0728);
  CHECK(holds(messages[0].help, "300 mm/min are 5 mm/s"));
  CHECK(holds(messages[1].help, "0.4 m/s2 are 400 mm/s2"));
  CHECK(holds(messages[2].help, "5000 ms are 5 s"));

  for (const auto& [unit_s, help] : {std::pair{60.0, "0.0833 minutes are 5 s"},
                                     {3600.0, "0.00139 hours are 5 s"},
                                     {86400.0, "5.79e-05 days are 5 s"}}) {
    messages.clear();
    doubt_motion(damaged([&](RecordingRow& row) { *row.time_s /= unit_s; }), "r.csv", messages);
    REQUIRE(messages.size() == 1);
    CHECK(messages[0].code == Code::W0728);
    CHECK(holds(messages[0].help, help));
  }
}

TEST_CASE("scale readings that are not those of the touches are not used") {
  Recording commanded = damaged([](RecordingRow& row) { row.reading_mm = *row.target_mm + Vec3{-40, 65, 180}; });
  const auto told = said_by(leave_out_commanded_readings, commanded);
  REQUIRE(told.size() == 1);
  CHECK(told[0].code == Code::W0729);
  CHECK(!commanded.rows.front().reading_mm);

  Recording coarse = damaged([](RecordingRow& row) {
    for (int axis = 0; axis < 3; ++axis) (*row.reading_mm)[axis] = 0.01 * std::round(100 * (*row.reading_mm)[axis]);
  });
  CHECK(reading_step_mm(coarse) == doctest::Approx(0.01));
  const auto steps = said_by(leave_out_readings_without_phase, coarse);
  REQUIRE(steps.size() == 1);
  CHECK(steps[0].code == Code::W0731);
  CHECK(holds(steps[0].message, "steps of 10 um"));

  Recording still = damaged([](RecordingRow& row) { row.reading_mm->y = 12.3456; });
  CHECK(holds(said_by(leave_out_readings_without_phase, still).at(0).message, "enc_y is the same in all rows"));
  CHECK(readings_agree(of_three_balls(), Places::targets));
  CHECK(!readings_agree(still, Places::targets, 1));
}

TEST_CASE("directions of travel that cannot be are left out or refused") {
  Recording one_way = damaged([](RecordingRow& row) { row.travel = Vec3{0, 0, -1}; });
  const auto told = said_by(leave_out_constant_travel, one_way);
  REQUIRE(told.size() == 1);
  CHECK(told[0].code == Code::W0732);
  CHECK(!one_way.rows.front().travel);

  const Recording swapped = damaged([](RecordingRow& row) {
    row.travel = Vec3{row.travel->y, row.travel->x, row.travel->z};
  });
  std::vector<const RecordingRow*> rows;
  for (const RecordingRow& row : swapped.rows) rows.push_back(&row);
  const Mat3 as_placed;
  const Diagnostic d = refusal([&] { check_normals(rows, as_placed, "r.csv"); });
  CHECK(d.code == Code::E0701);
  CHECK(holds(d.help, "ax, ay, az as they are now ay, ax, az"));
}

TEST_CASE("rows far from their targets are left out where they are few") {
  Recording r = of_three_balls();
  r.rows[7].position_mm.x += 500;
  const auto told = said_by(leave_out_astray, r);
  REQUIRE(told.size() == 1);
  CHECK(told[0].code == Code::W0712);
  CHECK(holds(told[0].message, "touch 2 of 'BALL2' (line 9)"));
  CHECK(r.rows.size() == 17);

  Recording many = of_three_balls();
  for (std::size_t i = 0; i < 4; ++i) many.rows[4 * i].position_mm.y -= 150.0 * double(i + 1);
  std::vector<Diagnostic> messages;
  CHECK(refusal([&] { leave_out_astray(many, "r.csv", messages); }).code == Code::E0711);
}

TEST_CASE("surfaces that no one stylus reaches need to say which touched them") {
  const auto unlogged = [](RecordingRow& row) { row.sensor.reset(), row.head_a_deg.reset(), row.head_b_deg.reset(); };
  std::vector<Diagnostic> messages;
  CHECK(!styli_unlogged(damaged(unlogged), "r.csv", messages));  // from above, one reaches all
  CHECK(styli_unlogged(damaged([&](RecordingRow& row) {
                         unlogged(row);
                         if (row.touch == 6) row.normal = Vec3{0, 0, -1};
                       }),
                       "r.csv", messages));
  REQUIRE(messages.size() == 1);
  CHECK(messages[0].code == Code::W0725);
  CHECK(least_along_the_best({{0, 0, 1}}) == doctest::Approx(1));
  CHECK(least_along_the_best({{1, 0, 0}, {-1, 0, 0}}) == doctest::Approx(0));
}
