#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "engine/features/points_csv.hpp"

using namespace abbe;

namespace {

std::vector<Vec3> read(std::string text) { return points_from_csv(SourceFile("points.csv", std::move(text))); }

/// "code line:column" of every message.
std::string refusal(std::string text) {
  try {
    read(std::move(text));
  } catch (const UserError& e) {
    std::string all;
    for (const Diagnostic& d : e.diagnostics())
      all += std::string(info(d.code).name) + " " + std::to_string(d.place.line) + ":" +
          std::to_string(d.place.column) + "\n";
    return all;
  }
  return "none";
}

}  // namespace

TEST_CASE("points are read as they were printed") {
  const auto points = read("x,y,z\n0.1, -2e-3 ,+3\n10000.000042437567,0,-0\n");
  REQUIRE(points.size() == 2);
  CHECK(points[0] == Vec3{0.1, -2e-3, 3});
  CHECK(points[1].x == 10000.000042437567);
}

TEST_CASE("line ends, byte order marks and blank lines at the end do not matter") {
  CHECK(read("\xEF\xBB\xBFx, y, z\r\n1,2,3\r\n4,5,6\r\n\r\n\r\n").size() == 2);
  CHECK(read("X,Y,Z\n1,2,3").size() == 1);
  CHECK(read("x,y,z\n").empty());
}

TEST_CASE("nan and inf are left for the fit to refuse") {
  const auto points = read("x,y,z\nnan,inf,-inf\n");
  CHECK(std::isnan(points[0].x));
  CHECK(points[0].y == INFINITY);
  CHECK(points[0].z == -INFINITY);
}

TEST_CASE("every mistake has its place") {
  CHECK(refusal("") == "E0501 1:1\n");
  CHECK(refusal("1,2,3\n") == "E0501 1:1\n");
  CHECK(refusal("x;y;z\n1;2;3\n") == "E0501 1:1\n");
  CHECK(refusal("x,y,z\n1,2\n1,2,3,4\n") == "E0502 2:1\nE0502 3:1\n");
  CHECK(refusal("x,y,z\n1,2,3\n\n4,5,6\n") == "E0502 3:1\n");
  CHECK(refusal("x,y,z\n1, two,3\n1,2,3mm\n1,,3\n") == "E0503 2:4\nE0503 3:5\nE0503 4:3\n");
  CHECK(refusal("x,y,z\n1,2,1e999\n") == "E0503 2:5\n");
  CHECK(refusal("x,y,z\n1,2,+-3\n") == "E0503 2:5\n");
}

TEST_CASE("a broken file does not flood the screen") {
  std::string text = "x,y,z\n";
  for (int i = 0; i < 1000; ++i) text += "a,b\n";
  const std::string messages = refusal(text);
  CHECK(std::count(messages.begin(), messages.end(), '\n') == 10);
}
