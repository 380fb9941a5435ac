#include "engine/diagnose/explanations/parameter_grid.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <utility>
#include <vector>

using namespace abbe;
using namespace abbe::diagnose;

namespace {

/// The parameter of an effect that is sought in this way.
const EffectParameter& parameter_sought(const char* effect, Sought how) {
  const auto& all = find_effect(effect)->parameters;
  const auto found = std::find_if(all.begin(), all.end(), [how](const EffectParameter& p) { return p.sought == how; });
  REQUIRE(found != all.end());
  return *found;
}

std::vector<double> values(const ParameterGrid& grid) {
  std::vector<double> list;
  for (const TriedValue& at : grid.tried) list.push_back(at.value);
  return list;
}

RecordedTouches touched_at(const std::vector<double>& times_s) {
  RecordedTouches t;
  t.touches.resize(times_s.size());
  for (std::size_t i = 0; i < times_s.size(); ++i) t.touches[i].scene.time_s = times_s[i];
  return t;
}

}  // namespace

TEST_CASE("moments are tried between touches, each for as many gaps, from the first touch to the last") {
  const EffectParameter& moment = parameter_sought("part.shift", Sought::moment);
  std::vector<double> times_s;
  for (int i = 0; i < 200; ++i) times_s.push_back(5 * i + (i >= 60 ? 3600 : 0) + (i % 3 == 0 ? 2 : 0));
  const ParameterGrid grid = grid_of(moment, touched_at(times_s));
  REQUIRE(grid.tried.size() == 32);
  CHECK(grid.between);
  const auto touch_at = [&](double time_s) { return std::find(times_s.begin(), times_s.end(), time_s); };
  double reached_s = times_s.front();
  for (const auto& [value, cell, share] : grid.tried) {
    CHECK(cell.low == reached_s);
    REQUIRE(touch_at(cell.high) != times_s.end());
    const auto gaps = touch_at(cell.high) - touch_at(cell.low);
    CHECK(gaps >= 199 / 32);
    CHECK(gaps <= 199 / 32 + 1);
    CHECK(share == doctest::Approx(double(gaps) / 199));
    CHECK(value > cell.low);
    CHECK(value < cell.high);
    CHECK(touch_at(value) == times_s.end());
    reached_s = cell.high;
  }
  CHECK(reached_s == times_s.back());
}

TEST_CASE("touches at one time have no moment between them") {
  const EffectParameter& moment = parameter_sought("part.shift", Sought::moment);
  CHECK(values(grid_of(moment, touched_at({0, 0, 4, 4, 4, 10}))) == std::vector<double>{2, 7});
  CHECK(values(grid_of(moment, touched_at({3, 3, 3}))).empty());
}

TEST_CASE("the tip may be qualified at each of a few probing speeds, which a control holds roughly") {
  const EffectParameter& speed = parameter_sought("probe.trigger_delay", Sought::speed);
  const auto tried = [&](const std::vector<double>& speeds_mm_s) {
    RecordedTouches t = touched_at(std::vector<double>(speeds_mm_s.size()));
    for (std::size_t i = 0; i < speeds_mm_s.size(); ++i) t.touches[i].scene.speed_mm_s = speeds_mm_s[i];
    return values(grid_of(speed, t));
  };
  CHECK(tried({8, 3, 8, 3}) == std::vector<double>{0, 3, 8});
  CHECK(tried({8.1, 2.9, 8, 3, 7.9, 3.1}) == std::vector<double>{0, 3, 8});
  CHECK(tried({8, 8}) == std::vector<double>{0});
  CHECK(tried({1, 2, 3, 4, 5, 6}) == std::vector<double>{0});
}

TEST_CASE("no wave of a part is longer than two parts as large as what was touched") {
  const EffectParameter& wavelength = parameter_sought("part.form", Sought::wavelength);
  const auto tried = [&](double extent_mm) {
    RecordedTouches t;
    t.touches.resize(2);
    t.touches[1].scene.on_part = {0, extent_mm, 1};
    return values(grid_of(wavelength, t));
  };
  CHECK(tried(20) == std::vector<double>{50});  // the shortest is always tried
  CHECK(tried(50) == std::vector<double>{50, 70, 100});
  CHECK(tried(300).size() == wavelength.tried.size());
}

TEST_CASE(
    "a room's control is sought down to ten minutes, in a short recording less, each cycle of a recording twice") {
  const EffectParameter& period = parameter_sought("thermal.cycle", Sought::period);
  const auto tried = [&](double duration_s) {
    RecordedTouches t;
    t.touches.resize(2);
    t.touches[1].scene.time_s = duration_s;
    return values(grid_of(period, t));
  };
  const double day = 24 * 3600;
  for (const auto& [duration_s, quickest_s] :
       {std::pair{100 * day, 100 * day / 500}, {day, 600.0}, {15000.0, 600.0}, {4200.0, 300.0}, {1500.0, 120.0}}) {
    const std::vector<double> all = tried(duration_s);
    REQUIRE(!all.empty());
    CHECK(all.front() == 2 * duration_s);
    for (std::size_t k = 1; k < all.size(); ++k)
      CHECK(duration_s / all[k] - duration_s / all[k - 1] == doctest::Approx(0.5));
    CHECK(all.back() >= quickest_s);
    CHECK(duration_s / all.back() + 0.5 > duration_s / quickest_s);
    CHECK(quickest_of_a_room_s(duration_s) == doctest::Approx(quickest_s));
  }
}
