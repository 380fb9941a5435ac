// The effects of the noise: their distributions, found by running through the normal quantiles.
#include "engine/effects/noise/noise.hpp"

#include <cmath>

#include "engine/math/normal.hpp"
#include "tests/unit/effects/bench.hpp"

namespace abbe {

using namespace effects_test;

namespace {

/// The standard normal number below which a share p lies, by bisection: no library needed.
double quantile(double p) {
  double low = -10, high = 10;
  for (int i = 0; i < 80; ++i) {
    const double middle = (low + high) / 2;
    (normal_below(middle) < p ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// Mean and standard deviation, um, over evenly spread quantiles of the first draw.
struct Moments {
  double mean = 0, sd = 0;
};
Moments moments(const Effect& effect, const TouchScene& scene, Parameters named) {
  constexpr int kSteps = 4000;
  double sum = 0, squares = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double r = reading_um(effect, scene, named, {quantile((i + 0.5) / kSteps)});
    sum += r, squares += r * r;
  }
  const double mean = sum / kSteps;
  return {mean, std::sqrt(squares / kSteps - mean * mean)};
}

}  // namespace

TEST_CASE("vibration: no mean, the given spread along any normal") {
  const Vec3 oblique = unit(Vec3{1, 2, -2});
  const Moments m = moments(kVibration, touch(oblique), {{"sd_um", 0.4}});
  CHECK(std::fabs(m.mean) < 1e-6);
  CHECK(m.sd == doctest::Approx(0.4).epsilon(0.002));
}

TEST_CASE("vibration: of one axis it shows in proportion to the normal") {
  const auto sd = [](const Vec3& normal) {
    return moments(kVibration, touch(normal), {{"sd_um", 0.4}, {"direction", 1}}).sd;
  };
  CHECK(sd({0, 1, 0}) == doctest::Approx(0.4).epsilon(0.002));
  CHECK(sd({0, 0.6, 0.8}) == doctest::Approx(0.24).epsilon(0.002));
  CHECK(sd({1, 0, 0}) == 0);
}

TEST_CASE("outliers: the given share, all on one side, 3 to 50 um for a median of 12") {
  const TouchScene scene = touch({0, 0, 1});
  const Parameters dirt = {{"share", 0.02}};
  constexpr int kSteps = 2000;
  int outliers = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double r = reading_um(kOutliers, scene, dirt, {quantile((i + 0.5) / kSteps), 0});
    CHECK(r >= 0);
    if (r > 0) ++outliers;
  }
  CHECK(outliers == 40);
  CHECK(reading_um(kOutliers, scene, dirt, {-5, 0}) == doctest::Approx(12));
  CHECK(reading_um(kOutliers, scene, dirt, {-5, -1.96}) == doctest::Approx(3).epsilon(0.02));
  CHECK(reading_um(kOutliers, scene, dirt, {-5, 1.96}) == doctest::Approx(47).epsilon(0.02));
}

TEST_CASE("outliers: a share of them lies on the other side") {
  int out = 0, in = 0;
  for (int i = 0; i < 2000; ++i) {
    const double r =
        reading_um(kOutliers, touch({0, 0, 1}), {{"share", 0.02}, {"opposite", 0.25}}, {quantile((i + 0.5) / 2000), 0});
    out += r > 0 ? 1 : 0, in += r < 0 ? 1 : 0;
  }
  CHECK(out == 30);
  CHECK(in == 10);
}

TEST_CASE("outliers: none when their share is not given") {
  CHECK(displacement_mm(kOutliers, touch({0, 0, 1}), {}, {-8, 0}) == Vec3{});
}

TEST_CASE("resolution: 1 um rounding is uniform with a standard deviation of 0.29 um") {
  const TouchScene scene = touch({0, 0, 1});
  const Moments m = moments(kResolution, scene, {{"resolution_um", 1}});
  CHECK(std::fabs(m.mean) < 1e-6);
  CHECK(m.sd == doctest::Approx(1 / std::sqrt(12.)).epsilon(1e-4));
  CHECK(reading_um(kResolution, scene, {{"resolution_um", 1}}, {9}) == doctest::Approx(0.5));
  CHECK(reading_um(kResolution, scene, {{"resolution_um", 1}}, {-9}) == doctest::Approx(-0.5));
}

TEST_CASE("unequal: brings the group to its ratio and leaves the others alone") {
  const Parameters twice = {{"ratio", 2}, {"sd_um", 0.5}};
  const Moments long_stylus = moments(kUnequalNoise, touch({0, 0, 1}, 150), twice);
  CHECK(std::hypot(long_stylus.sd, 0.5) == doctest::Approx(1.0).epsilon(0.002));
  CHECK(std::fabs(long_stylus.mean) < 1e-6);
  CHECK(displacement_mm(kUnequalNoise, touch({0, 0, 1}, 50), twice, {1}) == Vec3{});
  CHECK(displacement_mm(kUnequalNoise, touch({0, 0, 1}, 150), {{"ratio", 1}}, {1}) == Vec3{});
}

TEST_CASE("unequal: the group may be a tilted head, fast probing or one orientation of the head") {
  const auto acts = [](const TouchScene& scene, double group) {
    const Parameters p = {{"ratio", 2}, {"group", group}, {"head_a_deg", 90}, {"head_b_deg", -180}};
    return displacement_mm(kUnequalNoise, scene, p, {1}) != Vec3{};
  };
  CHECK(acts(touch({0, 0, 1}, 50, kPi / 2), 1));
  CHECK(acts(touch({0, 0, 1}, 50, -kPi / 2), 1));
  CHECK(!acts(touch({0, 0, 1}, 50, 0), 1));
  TouchScene slow = touch({0, 0, 1});
  slow.speed_mm_s = 3;
  CHECK(acts(touch({0, 0, 1}), 2));
  CHECK(!acts(slow, 2));
  TouchScene aside = touch({0, 0, 1}, 50, kPi / 2);
  CHECK(!acts(aside, 3));
  aside.stylus.head_b_rad = kPi;  // the other way round to the same place
  CHECK(acts(aside, 3));
}

TEST_CASE("unequal: the group may be one feature, one setup, one run or a stretch of time") {
  const auto acts = [](double group, const char* which, double value, auto change) {
    TouchScene scene = touch({0, 0, 1});
    scene.feature = 2, scene.setup = 5, scene.run = 7, scene.time_s = 300;
    change(scene);
    const Parameters p = {{"ratio", 2}, {"group", group}, {"to_s", 400}, {which, value}};
    return displacement_mm(kUnequalNoise, scene, p, {1}) != Vec3{};
  };
  const auto as_it_is = [](TouchScene&) {};
  CHECK(acts(4, "feature", 3, as_it_is));  // features count from 1
  CHECK(!acts(4, "feature", 2, as_it_is));
  CHECK(acts(5, "setup", 5, as_it_is));
  CHECK(!acts(5, "setup", 5, [](TouchScene& s) { s.setup = 4; }));
  CHECK(acts(6, "run", 7, as_it_is));
  CHECK(!acts(6, "run", 7, [](TouchScene& s) { s.run = 0; }));
  CHECK(acts(7, "from_s", 300, as_it_is));
  CHECK(acts(7, "from_s", 300, [](TouchScene& s) { s.time_s = 400; }));
  CHECK(!acts(7, "from_s", 301, as_it_is));
  CHECK(!acts(7, "from_s", 300, [](TouchScene& s) { s.time_s = 400.1; }));
}

}  // namespace abbe
