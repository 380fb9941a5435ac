#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "engine/base/diagnostic.hpp"
#include "engine/recording/clock.hpp"
#include "engine/recording/columns.hpp"
#include "engine/recording/copies.hpp"
#include "engine/recording/recording.hpp"
#include "engine/recording/sensor_line.hpp"

using namespace abbe;

TEST_CASE("what is written is read back") {
  Recording r;
  r.metadata = {{"machine", "m"}};
  RecordingRow row;
  row.feature = "A \"quoted\", label";
  row.touch = 3;
  row.position_mm = {1.25, -2.5, -1e-9};  // less than the last digit: no negative zero
  row.target_mm = Vec3{1, -2, 0};
  row.normal = Vec3{0, 0, 1};
  row.sensor = "S1";
  row.head_a_deg = -90;
  row.head_b_deg = 45;
  row.time_s = 12.5;
  row.travel = Vec3{0, 0, -1};
  row.reading_mm = Vec3{4, 5, 6};
  r.rows = {row, row};
  r.rows[1].sensor.reset();
  r.rows[1].time_s.reset();
  r.point = RecordedPoint::surface;
  CHECK(to_csv(r).find(",1.2500000,-2.5000000,0.0000000,") != std::string::npos);
  const Recording back = read_recording(SourceFile("r.csv", to_csv(r)));
  REQUIRE(back.rows.size() == 2);
  CHECK(back.metadata == r.metadata);
  CHECK(back.point == RecordedPoint::surface);
  CHECK(back.rows[0].feature == row.feature);
  CHECK(back.rows[0].touch == 3);
  CHECK(back.rows[0].position_mm == Vec3{1.25, -2.5, 0});
  CHECK(back.rows[0].head_a_deg == -90);
  CHECK(back.rows[0].head_b_deg == 45);
  CHECK(back.rows[0].time_s == 12.5);
  CHECK_FALSE(back.in_part_frame);
  CHECK(*back.rows[0].normal == *row.normal);
  CHECK(*back.rows[0].reading_mm == *row.reading_mm);
  CHECK(*back.rows[0].sensor == "S1");
  CHECK_FALSE(back.rows[1].time_s.has_value());
  CHECK(back.rows[0].line == 5);
  r.point = RecordedPoint::tip_centre;
  r.in_part_frame = true;
  const Recording other = read_recording(SourceFile("r.csv", to_csv(r)));
  CHECK(other.point == RecordedPoint::tip_centre);
  CHECK(other.in_part_frame);
}

TEST_CASE("every column is read and written, and docs/recording.md has it") {
  std::ifstream stream(ABBE_SOURCE_DIR "/docs/recording.md");
  const std::string docs{std::istreambuf_iterator<char>(stream), {}};
  std::string header, row;
  for (const RecordingColumn& column : recording_columns())
    for (const std::string_view name : column.names) {
      if (name.empty()) continue;
      CHECK_MESSAGE(docs.find("`" + std::string(name) + "`") != std::string::npos, name);
      header += (header.empty() ? "" : ",") + std::string(name);
      row += (row.empty() ? "" : ",") + std::string(column.unit_vector && name != column.names[0] ? "0" : "1");
    }
  const std::string csv = to_csv(read_recording(SourceFile("r.csv", header + "\n" + row + "\n")));
  CHECK_MESSAGE(csv.find("\n" + header + "\n1,1,1.0000000,") != std::string::npos, csv);
}

TEST_CASE("CRLF, byte order mark and blanks do not matter") {
  const Recording r = read_recording(
      SourceFile("r.csv", "\xEF\xBB\xBF# free text\r\nfeature, touch, x,y,z\r\n A , 1, +1.5, 2,3\r\n\r\n"));
  REQUIRE(r.rows.size() == 1);
  CHECK(r.rows[0].feature == "A");
  CHECK(r.rows[0].position_mm == Vec3{1.5, 2, 3});
}

TEST_CASE("every mistake has its place") {
  try {
    read_recording(SourceFile("r.csv", "feature,touch,x,y,z\nA,1,0,0,0\nA,two,0,0,0\nA,3,0,0,1e999\n"));
    FAIL("a recording with mistakes was read");
  } catch (const UserError& e) {
    REQUIRE(e.diagnostics().size() >= 2);
    CHECK(e.diagnostics()[0].place == Place{3, 3});
    CHECK(e.diagnostics()[1].place == Place{4, 9});
  }
}

TEST_CASE("lines before the table and counts say something possible, or are refused where they stand") {
  const auto refused = [](const std::string& remark, const std::string& columns, const std::string& row) {
    try {
      read_recording(SourceFile("r.csv", remark + columns + "\n" + row + "\n"));
    } catch (const UserError& e) {
      REQUIRE(e.diagnostics().size() == 1);
      return e.diagnostics()[0];
    }
    FAIL(remark << row << " was read");
    return Diagnostic{};
  };
  for (const char* remark : {"# approach_mm: -3\n", "# retract_mm: three\n", "# retract_mm: 1e300\n",
                             "# temperature_compensation: maybe\n", "# frame: free text\n", "# point: tip\n"}) {
    CAPTURE(remark);
    const Diagnostic d = refused(remark, "feature,touch,x,y,z", "A,1,0,0,0");
    CHECK(d.code == Code::E0525);
    CHECK(d.place.line == 1);
    CHECK_FALSE(d.help.empty());
  }
  for (const auto& [columns, row] : {std::pair{"feature,touch,x,y,z", "A,0,0,0,0"},
                                     {"feature,touch,setup,x,y,z", "A,1,0,0,0,0"},
                                     {"feature,touch,run,x,y,z", "A,1,-1,0,0,0"},
                                     {"feature,touch,x,y,z", "A,1.5,0,0,0"},
                                     {"feature,touch,x,y,z", ",1,0,0,0"},
                                     {"feature,touch,x,y,z", "A,,0,0,0"},
                                     {"feature,touch,x,y,z,head_A_deg", "A,1,0,0,0,1e308"},
                                     {"feature,touch,x,y,z,time_s", "A,1,0,0,0,-1e300"},
                                     {"feature,touch,x,y,z,speed_mm_s", "A,1,0,0,0,-5"},
                                     {"feature,touch,x,y,z,temp_part_C", "A,1,0,0,0,-999"},
                                     {"feature,touch,x,y,z,load_kg", "A,1,0,0,0,1e12"}}) {
    CAPTURE(row);
    const Diagnostic d = refused("", columns, row);
    CHECK(d.code == Code::E0530);
    CHECK(d.place.line == 2);
  }
  const Recording r = read_recording(SourceFile(
      "r.csv",
      "# approach_mm: 0\n# retract_mm: 3.5\n# temperature_compensation: off\n# note: anything\nfeature,touch,x,y,z\nA,1,0,0,0\n"));
  CHECK(r.metadata.size() == 4);
}

TEST_CASE("vectors are whole, and directions have the length 1") {
  const auto read = [](const std::string& header, const std::string& row) {
    return read_recording(SourceFile("r.csv", header + "\n" + row + "\n"));
  };
  const auto code_of = [&](const std::string& header, const std::string& row) {
    try {
      read(header, row);
    } catch (const UserError& e) {
      return e.diagnostics().front().code;
    }
    FAIL(row << " was read");
    return Code{};
  };
  const std::string with_targets = "feature,touch,x,y,z,tx,ty,tz", with_normals = "feature,touch,x,y,z,nx,ny,nz";
  CHECK(code_of(with_targets, "A,1,0,0,0,1,2,") == Code::E0528);
  CHECK(code_of(with_targets, "A,1,0,0,0,1,,") == Code::E0528);
  CHECK(code_of(with_targets, "A,1,,,,1,2,3") == Code::E0528);  // where it was to be is not where it was
  CHECK_FALSE(read(with_targets, "A,1,0,0,0,,,").rows[0].target_mm);
  CHECK(code_of(with_normals, "A,1,0,0,0,0,0.6,0.84") == Code::E0529);   // length 1.032
  const Recording rounded = read(with_normals, "A,1,0,0,0,0,0.6,0.81");  // length 1.008: few decimals
  CHECK(norm(*rounded.rows[0].normal) == doctest::Approx(1).epsilon(1e-15));
  CHECK(rounded.rows[0].normal->y == doctest::Approx(0.6 / std::hypot(0.6, 0.81)).epsilon(1e-15));
}

TEST_CASE("a stylus is described by its words, each with its numbers") {
  CHECK(read_sensor_line("tip_in_r_mm 0 0 -100 diameter_mm 4 shaft_diameter_mm 4").mistake.empty());
  for (const char* line :
       {"tip_in_r_mm 0 0 -100", "diameter_mm 4", "tip_in_r_mm 0 0 diameter_mm 4", "tip_in_r_mm 0 0 -100 diameter_mm",
        "tip_in_r_mm 0 0 -100 diameter_mm 4 shaft_diameter_mm 4.1", "tip_in_r_mm 0 0 -100 diameter_mm 0"})
    CHECK_MESSAGE(!read_sensor_line(line).mistake.empty(), std::string(line));
}

TEST_CASE("one line may be said twice, but only in one meaning") {
  const auto read = [](const std::string& second) {
    return read_recording(
        SourceFile("r.csv", "# retract_mm: 3.5\n# retract_mm: " + second + "\nfeature,touch,x,y,z\nA,1,0,0,0\n"));
  };
  CHECK(read("3.50").rows.size() == 1);
  CHECK_THROWS_AS(read("3"), UserError);
  const Recording misspelt = read_recording(
      SourceFile("r.csv", "# stylus A: tip_in_r_mm 0 0 -100 diameter_mm 4\nfeature,touch,x,y,z\nA,1,0,0,0\n"));
  REQUIRE(misspelt.messages.size() == 1);
  CHECK(misspelt.messages[0].help == "did you mean '# sensor NAME:'?");
}

TEST_CASE("words of surfaces, and lines of rows") {
  CHECK(find_surfaces("calibrated") == Surfaces::calibrated);
  CHECK(find_surfaces("unknown_size") == Surfaces::unknown_size);
  CHECK(find_surfaces("unknown") == Surfaces::unknown);
  Recording r;
  r.files = {"a.csv"};
  RecordingRow row;
  row.line = 7;
  CHECK(line_of(r, row) == "line 7");
  r.files.push_back("b.csv");
  row.file = 1;
  CHECK(line_of(r, row) == "line 7 of b.csv");
}

TEST_CASE("a clock that begins again goes on a minute after the one before") {
  const auto at = [](std::initializer_list<double> times) {
    std::vector<RecordingRow> rows(times.size());
    std::transform(times.begin(), times.end(), rows.begin(), [](double t) {
      RecordingRow row;
      row.time_s = t;
      return row;
    });
    return rows;
  };
  const std::vector<RecordingRow> ahead = at({10, 100});
  std::vector<RecordingRow> next = at({0, 90, 10});  // the clock of its own
  CHECK(continue_clock(ahead, next) == 160);         // 100 and 60, less the 0 at which it begins
  CHECK(next[0].time_s == 160);
  CHECK(next[1].time_s == 250);
  std::vector<RecordingRow> ends_together = at({50, 100}), after = at({101, 200}), before = at({0, 9});
  CHECK(continue_clock(ahead, ends_together) == 110);
  CHECK_FALSE(continue_clock(ahead, after));
  CHECK(after[0].time_s == 101);
  CHECK_FALSE(continue_clock(ahead, before));  // files in another order are no two clocks
  std::vector<RecordingRow> unlogged(2);
  CHECK_FALSE(continue_clock(ahead, unlogged));
}

TEST_CASE("rows are copies where nine tenths of the smaller group stand in the other") {
  // Ten touches of one group, of which `alike` are in the second too; `more`: touches of the second alone.
  const auto copied = [](int alike, int more, double step_mm, bool at_targets = false, std::size_t fewest = 1) {
    std::vector<RecordingRow> rows;
    std::vector<int> group;
    const auto add = [&](int touch, double x, int in) {
      RecordingRow row;
      row.feature = "A";
      row.touch = touch;
      row.position_mm = {x, 3 * step_mm, 0};
      if (at_targets) row.target_mm = row.position_mm;
      rows.push_back(row);
      group.push_back(in);
    };
    for (int k = 0; k < 10; ++k) add(k + 1, step_mm * (7 * k + 1), 0);
    for (int k = 0; k < 10 + more; ++k) add(k + 1, step_mm * (7 * k + (k < alike ? 1 : 2)), 1);
    std::vector<const RecordingRow*> pointers;
    for (const RecordingRow& row : rows) pointers.push_back(&row);
    return copied_group(pointers, group, fewest).has_value();
  };
  CHECK(copied(9, 0, 1e-4));
  CHECK_FALSE(copied(8, 0, 1e-4));
  CHECK(copied(9, 10, 1e-4));              // all but one of the smaller
  CHECK_FALSE(copied(10, 0, 2e-3));        // steps that repeat by themselves
  CHECK_FALSE(copied(10, 0, 1e-4, true));  // targets were not measured
  CHECK(copied(10, 0, 1e-4, false, 10));
  CHECK_FALSE(copied(10, 0, 1e-4, false, 11));
}

TEST_CASE("rounded readings are multiples of the step, the nearest ones") {
  Recording r;
  r.rows.resize(2);
  r.rows[0].position_mm = {1.2344, -1.2346, 0};
  r.rows[1].reading_mm = Vec3{10.0051, 0, 0};
  round_readings(r, 0.01);
  CHECK(r.rows[0].position_mm.x == doctest::Approx(1.23));
  CHECK(r.rows[0].position_mm.y == doctest::Approx(-1.23));
  CHECK(r.rows[1].reading_mm->x == doctest::Approx(10.01));
  CHECK_FALSE(r.rows[0].reading_mm);
  round_readings(r, 1e-311);
  CHECK(r.rows[0].position_mm.x == doctest::Approx(1.23));
}
