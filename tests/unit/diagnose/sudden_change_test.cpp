#include "engine/diagnose/baseline/sudden_change.hpp"

#include <doctest/doctest.h>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/diagnose/model/noise_law.hpp"
#include "engine/lanes/random.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

constexpr int kOnBall = 60;
constexpr int kMoment = 45;  // from this touch on
constexpr std::uint32_t kScatter = stream_of("test.sudden_change");

/// Touches one after another all over a ball that lies anywhere, on a machine with an error of 0.1 um and a
/// scatter of 0.5 um.
Case touches_of_a_ball() {
  Case c;
  LinearModel& m = c.baseline.model;
  m.free.resize(kOnBall, 3);
  m.random.resize(kOnBall, 1);
  m.random_group = {0};
  m.noise_um = Vector::Constant(kOnBall, 0.5);
  m.noise_group.assign(kOnBall, 0);
  m.follows.assign(kOnBall, 1);
  m.y = 0.5 * NoiseLaw().simulated(kOnBall, 3, kScatter, 0);
  c.hyper.noise = Vector::Ones(1);
  c.masked.assign(kOnBall, 0);
  for (int k = 0; k < kOnBall; ++k) {
    const double height = 1 - 2 * (k * 7 % kOnBall + 0.5) / kOnBall, across = std::sqrt(1 - height * height);
    RecordedTouch t;
    t.scene.normal = {across * std::cos(2.4 * k), across * std::sin(2.4 * k), height};
    t.scene.time_s = 3.0 * k;
    m.random(k, 0) = 0.1 * height;
    for (int axis = 0; axis < 3; ++axis) m.free(k, axis) = t.scene.normal[axis];
    c.touches.touches.push_back(t);
  }
  return c;
}

std::vector<char> struck_along_x(const Case& c, int from, double least) {
  std::vector<char> out(kOnBall, 0);
  for (int k = from; k < kOnBall; ++k)
    out[static_cast<std::size_t>(k)] = std::abs(c.touches.touches[static_cast<std::size_t>(k)].scene.normal.x) > least;
  return out;
}

}  // namespace

TEST_CASE("touches that one displacement explains from a moment on are no dirt") {
  Case c = touches_of_a_ball();
  for (int k = kMoment; k < kOnBall; ++k)
    c.baseline.model.y(k) += 30 * c.touches.touches[static_cast<std::size_t>(k)].scene.normal.x;
  c.masked = struck_along_x(c, kMoment, 0.4);
  CHECK(put_there_by_a_sudden_change(c) == c.masked);
}

TEST_CASE("dirt among them stays dirt") {
  Case c = touches_of_a_ball();
  for (int k = kMoment; k < kOnBall; ++k)
    c.baseline.model.y(k) += 30 * c.touches.touches[static_cast<std::size_t>(k)].scene.normal.x;
  std::vector<char> struck = struck_along_x(c, kMoment, 0.4);
  c.masked = struck;
  c.masked[kMoment - 5] = 1, c.baseline.model.y(kMoment - 5) += 40;
  CHECK(put_there_by_a_sudden_change(c) == struck);
}

TEST_CASE("touches that are off each by its own amount, or a single one, are left out") {
  Case c = touches_of_a_ball();
  const std::vector<char> none(kOnBall, 0);
  const std::pair<int, double> dirt_um[] = {{20, 40}, {24, -35}, {33, 60}, {41, -50}};
  for (const auto& [k, off_um] : dirt_um) c.masked[static_cast<std::size_t>(k)] = 1, c.baseline.model.y(k) += off_um;
  CHECK(put_there_by_a_sudden_change(c) == none);
  Case single = touches_of_a_ball();
  for (int k = kMoment; k < kOnBall; ++k)
    single.baseline.model.y(k) += 30 * single.touches.touches[static_cast<std::size_t>(k)].scene.normal.x;
  single.masked[kMoment + 1] = 1;
  CHECK(put_there_by_a_sudden_change(single) == none);
}
