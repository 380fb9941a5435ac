#include "engine/diagnose/explanations/search_grid.hpp"

#include <doctest/doctest.h>

#include <algorithm>

using namespace abbe;
using namespace abbe::diagnose;

TEST_CASE("no wave of a part is longer than two parts as large as what was touched") {
  const Effect& form = *find_effect("part.form");
  const auto wavelength = std::find_if(form.parameters.begin(), form.parameters.end(),
                                       [](const EffectParameter& p) { return p.sought == Sought::wavelength; });
  REQUIRE(wavelength != form.parameters.end());
  const auto tried = [&](double extent_mm) {
    RecordedTouches t;
    t.touches.resize(2);
    t.touches[1].scene.on_part = {0, extent_mm, 1};
    return search_of(*wavelength, t).values;
  };
  CHECK(tried(20) == std::vector<double>{50});  // the shortest is always tried
  CHECK(tried(50) == std::vector<double>{50, 70, 100});
  CHECK(tried(300).size() == wavelength->tried.size());
}
