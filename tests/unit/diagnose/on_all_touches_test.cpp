// What was named is taken out of every touch, and lengths are judged by what that leaves.
#include "engine/diagnose/findings/on_all_touches.hpp"

#include <doctest/doctest.h>

#include "engine/diagnose/baseline/length_errors.hpp"
#include "tests/unit/diagnose/scattered.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

/// A tip whose radius is wrong by so much, and among the touches three bars of 400 mm that are too long by `bars_um`.
struct Bars : Planted {
  Bars(double radius_um, double bars_um) : Planted(1) {
    machine.specification.mpe = {0.004, 0.004e-3};
    for (int i = 0; i < 6; ++i) {
      TouchScene& s = scene(i);
      s.normal = {i % 2 ? 1.0 : -1.0, 0, 0};
      s.point = s.reading = {i % 2 ? 450.0 : 50.0, 100, 100};
      s.stylus.tip_ordinal = 1;
      for (int k = 0; k < 3; ++k) c.model.free(i, k) = s.normal[k];
      c.model.random(i, 0) = s.normal.x * s.point.x / 500;
      c.model.y(i) = bars_um / 2;
    }
    plant("probe.tip_radius", {radius_um, 0});
    c.baseline.model = c.model;
    find({"probe.tip_radius"});
  }
};

}  // namespace

TEST_CASE("a length that is wrong stays wrong beside a name that makes little of it") {
  const Bars p(1, 20);
  const std::optional<LengthError> left = beyond_beside_names(p.c, p.result);
  REQUIRE(left);
  CHECK(left->length_mm == doctest::Approx(400));
  CHECK(kUmPerMm * left->error_mm == doctest::Approx(20).epsilon(0.1));
}

TEST_CASE("a name that makes all of a length leaves nothing of it") {
  Bars p(10, 0);
  CHECK(beyond_specification(worst_length(p.c.touches, without_placement(p.c.baseline.model), p.machine.specification),
                             p.machine));
  CHECK_FALSE(beyond_beside_names(p.c, p.result));
  p.result.hyper_of_likelier.noise *= 40;  // its size is still that of the recording, whatever is usual of it
  CHECK_FALSE(beyond_beside_names(p.c, p.result));
}
