#include "engine/diagnose/findings/known_effect.hpp"

#include <doctest/doctest.h>

using namespace abbe;
using abbe::diagnose::known_effect;
using abbe::diagnose::KnownEffect;

namespace {

std::optional<KnownEffect> found_beside(const EffectSetting& in_file, const EffectSetting& found) {
  Machine machine;
  machine.effects = {{"probe.cosine_error", {}}, in_file};
  return known_effect(machine, *find_effect(found.name), found);
}

EffectSetting scale(EffectSetting::Value axis, double value, double u) {
  return {"machine.scale", {{"axis", std::move(axis)}, {"scale_um_per_m", {value, u, {}}}}};
}

}  // namespace

TEST_CASE("sizes of an effect that is found again add, and the file has it once") {
  const auto known = found_beside(scale({0, 0, "x"}, 3, 0.3), scale({0, 0, "x"}, 2, 0.4));
  REQUIRE(known);
  CHECK(known->index == 1);
  CHECK(known->now.parameters.at("scale_um_per_m").value == 5);
  CHECK(known->now.parameters.at("scale_um_per_m").u == doctest::Approx(0.5));
  CHECK_FALSE(known->gone);
  CHECK(found_beside(scale({0, 0, "x"}, 3, 0.3), scale({0, 0, "x"}, -3, 0.4))->gone);
}

TEST_CASE("a choice is the same by its word and by its code") {
  CHECK(found_beside(scale({0, 0, {}}, 3, 0.3), scale({0, 0, "x"}, 2, 0.4)));
  CHECK(found_beside(scale({1, 0, {}}, 3, 0.3), scale({0, 0, "y"}, 2, 0.4)));
  CHECK_FALSE(found_beside(scale({1, 0, {}}, 3, 0.3), scale({0, 0, "x"}, 2, 0.4)));
  CHECK_FALSE(found_beside(scale({0, 0, "y"}, 3, 0.3), scale({0, 0, "x"}, 2, 0.4)));
}

TEST_CASE("of what draws its own numbers the variances add") {
  const auto known =
      found_beside({"noise.vibration", {{"sd_um", {3, 0.5, {}}}}}, {"noise.vibration", {{"sd_um", {4, 1, {}}}}});
  REQUIRE(known);
  CHECK(known->now.parameters.at("sd_um").value == doctest::Approx(5));
  CHECK(known->now.parameters.at("sd_um").u == doctest::Approx(std::hypot(3 * 0.5, 4 * 1) / 5));
  CHECK_FALSE(known->gone);
  CHECK_FALSE(
      found_beside({"noise.vibration", {{"sd_um", {0.1, 1, {}}}}}, {"noise.vibration", {{"sd_um", {0.1, 1, {}}}}})
          ->gone);
  CHECK_FALSE(found_beside({"noise.vibration", {{"direction", {0, 0, "x"}}}},
                           {"noise.vibration", {{"direction", {0, 0, "y"}}}}));
}

TEST_CASE("rounding and outliers are as the recording shows them, whatever the file had") {
  const auto known = found_beside({"noise.outliers", {{"share", {0.2, 0.01, {}}}}},
                                  {"noise.outliers", {{"share", {0.01, 0.001, {}}}}});
  REQUIRE(known);
  CHECK(known->instead);
  CHECK(known->now.parameters.at("share").value == 0.01);
  CHECK(found_beside({"noise.resolution", {{"resolution_um", {1, 0, {}}}}},
                     {"noise.resolution", {{"resolution_um", {5, 0, {}}}}})
            ->now.parameters.at("resolution_um")
            .value == 5);
}

TEST_CASE("sizes with a direction add as vectors, however their directions are written") {
  const auto drift = [](double um, EffectSetting::Value direction, double azimuth_deg) {
    return EffectSetting{"thermal.drift",
                         {{"amplitude_um", {um, 0.1, {}}},
                          {"direction", std::move(direction)},
                          {"azimuth_deg", {azimuth_deg, 1, {}}},
                          {"tau_s", {1000, 50, {}}}}};
  };
  // 4.5 um at 22 degrees, and what its mending looks like beside it.
  const auto mended = found_beside(drift(4.5, {0, 0, "oblique"}, 22), drift(4.4, {3, 0, {}}, -157));
  REQUIRE(mended);
  CHECK(mended->gone);
  // 3 um along x and 4 um along y are 5 um between them.
  const auto grown = found_beside(drift(3, {0, 0, "x"}, 0), drift(4, {0, 0, "y"}, 0));
  REQUIRE(grown);
  CHECK_FALSE(grown->gone);
  CHECK(grown->now.parameters.at("amplitude_um").value == doctest::Approx(5));
  CHECK(grown->now.parameters.at("direction").word == "oblique");
  CHECK(grown->now.parameters.at("azimuth_deg").value == doctest::Approx(53.130));
  CHECK(grown->now.parameters.at("elevation_deg").value == doctest::Approx(0));
  CHECK_FALSE(
      found_beside({"thermal.drift", {{"tau_s", {1000, 50, {}}}}}, {"thermal.drift", {{"tau_s", {4000, 50, {}}}}}));
}
