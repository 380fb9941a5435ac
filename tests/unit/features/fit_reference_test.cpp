// fit_points against exact minima (tests/reference/fits), each within its own tolerance.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/features/fit.hpp"

using namespace abbe;
using nlohmann::json;

namespace {

Shape shape_named(const std::string& name) {
  const std::pair<const char*, Shape> names[] = {
      {"line", Shape::line},         {"plane", Shape::plane}, {"circle", Shape::circle}, {"sphere", Shape::sphere},
      {"cylinder", Shape::cylinder}, {"cone", Shape::cone},   {"torus", Shape::torus}};
  for (const auto& [word, shape] : names)
    if (name == word) return shape;
  FAIL("unknown element " << name);
  return {};
}

Vec3 vector_of(const json& j) {
  const auto number = [](const json& x) { return x.is_string() ? std::stod(x.get<std::string>()) : x.get<double>(); };
  return {number(j[0]), number(j[1]), number(j[2])};
}

FitProblem problem_of(const json& j) {
  FitProblem problem{shape_named(j["element"]), {}, {}};
  for (const json& p : j["points"]) problem.points.push_back(vector_of(p));
  if (j["given"].contains("normal")) problem.normal = vector_of(j["given"]["normal"]);
  return problem;
}

void check_values(const json& expected, const FitSolution& solution, double mm, double rad, double apex_mm) {
  const Element& e = solution.element;
  const auto value = [&](const char* key, double actual, double tolerance, double unit = 1) {
    if (expected.contains(key)) CHECK(std::fabs(actual - expected[key].get<double>() * unit) <= tolerance);
  };
  for (const char* key : {"point", "center"})
    if (expected.contains(key)) CHECK(norm(e.point - vector_of(expected[key])) <= mm);
  for (const char* key : {"direction", "normal", "axis"})
    if (expected.contains(key)) CHECK(norm(e.direction - vector_of(expected[key])) <= rad);
  if (expected.contains("apex")) CHECK(norm(solution.apex - vector_of(expected["apex"])) <= apex_mm);
  for (const char* key : {"radius", "major_radius"}) value(key, e.size, mm);
  value("minor_radius", e.minor_size, mm);
  value("half_angle_deg", e.angle, rad, kPi / 180);
  value("rms", solution.rms, mm);
  value("form", solution.form, mm);
}

}  // namespace

TEST_CASE("reference cases") {
  int cases = 0;
  for (const auto& entry : std::filesystem::directory_iterator(ABBE_SOURCE_DIR "/tests/reference/fits")) {
    if (entry.path().extension() != ".json") continue;
    CAPTURE(entry.path().string());
    ++cases;
    std::ifstream file(entry.path());
    const json j = json::parse(file);
    const FitSolution solution = fit_points(problem_of(j));
    if (j.contains("expected_error")) {
      REQUIRE(solution.error);
      CHECK(solution.error->code == j["expected_error"]);
    } else {
      REQUIRE_FALSE(solution.error);
      check_values(j["expected"], solution, j["tolerance_mm"], j["tolerance_rad"], j.value("tolerance_apex_mm", 0.0));
    }
  }
  CHECK(cases == 63);
}
