// The form of the part as the effects see it while a program runs.
#include "engine/run/curved_features.hpp"
#include "tests/unit/whole/programs.hpp"

using namespace abbe;
using namespace abbe::test;
using doctest::Approx;

namespace {

/// By how much the only virtual machine finds a point too high, whose surface is wavy and has lobes.
double wave_at_point_um(const std::string& kind) {
  const SourceFile source("test.dmi",
                          kStart + measured("P", kind + ",CART,25,0,0,0,0,1", {"25,0,0,0,0,1"}) +
                              "T(Z)=TOL/CORTOL,ZAXIS,-1,1\nOUTPUT/FA(P),TA(Z)\nENDFIL\n");
  Sink sink;
  const plan::Plan plan = lang::compile(source, sink).plan;
  REQUIRE_FALSE(sink.has_errors());
  Machine machine = read_machine("coord3-mc16");
  machine.effects = {{"part.form", {{"wave_um", {10, 0, ""}}, {"egg_um", {100, 0, ""}}}}};
  RunOptions options;
  options.contributors.geometry = options.contributors.head = options.contributors.probe = false;
  const RunResult r = run_plan(plan, machine, screened_machines(machine, 1, 1, 1), options, source);
  return 1000 * (r.samples.at(0).value.at(0) - r.samples.at(0).reference.value());
}

}  // namespace

TEST_CASE("a point has one normal, as a face has: its form is the wave, as it is for a recording") {
  CHECK(wave_at_point_um("POINT") == Approx(10));  // a quarter of 100 mm from the origin of the part
}

TEST_CASE("features are curved by the normals of their touches") {
  CurvedFeatures touches;
  const auto add = [&](const std::string& feature, int setup, const Vec3& normal) {
    touches.add(feature, setup, 10 * normal, normal);
  };
  for (const Vec3& normal : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0.9987, 0.05, 0}}) add("SLOT", 1, normal);
  for (const Vec3& normal : {Vec3{1, 0, 0}, Vec3{0, 1, 0}}) add("BLOCK", 1, normal);
  for (int setup = 1; setup <= 2; ++setup)
    for (const double side : {1.0, -1.0}) add("GAUGE", setup, setup == 1 ? Vec3{side, 0, 0} : Vec3{0, side, 0});
  CHECK(touches.curved() == std::set<std::string>{"BLOCK"});
  CHECK(touches.touched("SLOT"));
  CHECK_FALSE(touches.touched("BORE"));
}

TEST_CASE("points are curved where all of them lie on one ball") {
  const std::vector<Vec3> directions{{1, 0, 0}, {-1, 0, 0},    {0, 1, 0},      {0, -1, 0},
                                     {0, 0, 1}, {0.6, 0, 0.8}, {0, -0.6, 0.8}, {-0.48, 0.64, 0.6}};
  const auto curved = [&](std::size_t count, double last_radius_mm) {
    CurvedFeatures touches;
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3& n = directions[k];
      const double radius_mm = k + 1 == count ? last_radius_mm : 12.5;
      touches.add("P" + std::to_string(k), 1, Vec3{100, 50, 30} + radius_mm * n, n);
    }
    return touches.curved().size();
  };
  CHECK(curved(8, 12.5) == 8);
  CHECK(curved(8, 12.6) == 0);  // of another surface
  CHECK(curved(6, 12.5) == 0);  // so do the faces of a cube
}
