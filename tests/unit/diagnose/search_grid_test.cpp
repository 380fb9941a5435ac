#include "engine/diagnose/explanations/search_grid.hpp"

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

}  // namespace

TEST_CASE("no wave of a part is longer than two parts as large as what was touched") {
  const EffectParameter& wavelength = parameter_sought("part.form", Sought::wavelength);
  const auto tried = [&](double extent_mm) {
    RecordedTouches t;
    t.touches.resize(2);
    t.touches[1].scene.on_part = {0, extent_mm, 1};
    return search_of(wavelength, t).values;
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
    return search_of(period, t).values;
  };
  const double day = 24 * 3600;
  for (const auto& [duration_s, quickest_s] :
       {std::pair{day, 600.0}, {15000.0, 600.0}, {4200.0, 300.0}, {1500.0, 120.0}}) {
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
