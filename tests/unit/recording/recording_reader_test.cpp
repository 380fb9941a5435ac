#include <doctest/doctest.h>

#include <fstream>
#include <iterator>

#include "engine/base/diagnostic.hpp"
#include "engine/recording/columns.hpp"
#include "engine/recording/recording.hpp"

using namespace abbe;

TEST_CASE("what is written is read back") {
  Recording r;
  r.metadata = {{"machine", "m"}};
  RecordingRow row;
  row.feature = "A \"quoted\", label";
  row.touch = 3;
  row.position_mm = {1.25, -2.5, 1e-3};
  row.target_mm = Vec3{1, -2, 0};
  row.normal = Vec3{0, 0, 1};
  row.sensor = "S1";
  row.head_a_deg = 90;
  row.time_s = 12.5;
  row.travel = Vec3{0, 0, -1};
  row.reading_mm = Vec3{4, 5, 6};
  r.rows = {row, row};
  r.rows[1].sensor.reset();
  r.rows[1].time_s.reset();
  r.point = RecordedPoint::surface;
  const Recording back = read_recording(SourceFile("r.csv", to_csv(r)));
  REQUIRE(back.rows.size() == 2);
  CHECK(back.metadata == r.metadata);
  CHECK(back.point == RecordedPoint::surface);
  CHECK(back.rows[0].feature == row.feature);
  CHECK(back.rows[0].touch == 3);
  CHECK(back.rows[0].position_mm == row.position_mm);
  CHECK(*back.rows[0].normal == *row.normal);
  CHECK(*back.rows[0].reading_mm == *row.reading_mm);
  CHECK(*back.rows[0].sensor == "S1");
  CHECK_FALSE(back.rows[1].time_s.has_value());
  CHECK(back.rows[0].line == 5);
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
