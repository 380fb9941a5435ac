// The signature of every effect that is listed, and what some of them must show.
#include "engine/figures/signature.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/figures/scenes.hpp"

namespace abbe {

namespace {

const Machine& machine() {
  static const Machine m = read_machine("coord3-mc16");
  return m;
}

Chart chart_of(std::string_view name) {
  const Effect* effect = find_effect(name);
  REQUIRE(effect != nullptr);
  return signature(*effect, machine());
}

double largest(const Chart::Series& s) {
  double most = 0;
  for (const double y : s.y) most = std::max(most, std::abs(y));
  return most;
}

/// The value of a series at the sample nearest to x.
double value_at(const Chart::Series& s, double x) {
  std::size_t best = 0;
  for (std::size_t i = 0; i < s.x.size(); ++i)
    if (std::abs(s.x[i] - x) < std::abs(s.x[best] - x)) best = i;
  return s.y[best];
}

/// r grows with the load: an effect that no figure was made for.
Vec3 made_up(const TouchScene& scene, const double* theta, const double*) {
  return theta[0] * scene.load_kg * scene.normal;
}

}  // namespace

TEST_CASE("every effect has a figure that shows something") {
  for (const Effect* effect : effects()) {
    CAPTURE(std::string(effect->name));
    const Chart c = signature(*effect, machine());
    CHECK(c.subtitle.starts_with(effect->name));
    CHECK(c.x_title.size() > 3);
    CHECK(c.series.size() >= 1);
    CHECK(c.series.size() <= 2);
    double most = 0;
    for (const Chart::Series& s : c.series) {
      CHECK(s.x.size() == s.y.size());
      for (const double y : s.y) CHECK(std::isfinite(y));
      most = std::max(most, largest(s));
    }
    CHECK(most > 0.01);  // um
    CHECK((c.mark == Chart::Mark::points) == (effect->draws_per == DrawsPer::touch));
  }
}

TEST_CASE("the abscissa is what an effect needs and depends on") {
  CHECK(chart_of("thermal.drift").x_title == "time since the start, min");
  CHECK(chart_of("probe.pretravel_lobing").x_title == "azimuth of the normal, °");
  CHECK(chart_of("probe.pretravel_lobing").series_title == "elevation of the normal, °");
  CHECK(chart_of("machine.squareness").x_title == "reading of y, mm");
  CHECK(chart_of("noise.unequal").x_title == "length of the stylus, mm");
  CHECK(chart_of("probe.tip_form").series_title == "virtual machine");
  CHECK(chart_of("thermal.table_bending").series_title == "touches on a face");
}

TEST_CASE("figures show the numbers of the formulas") {
  const Chart delay = chart_of("probe.trigger_delay");  // -0.2 ms v
  CHECK(value_at(delay.series[0], 10) == doctest::Approx(-2));
  const Chart backlash = chart_of("machine.backlash");
  CHECK(value_at(backlash.series[0], 5) == doctest::Approx(0.5));
  CHECK(value_at(backlash.series[0], 35) == doctest::Approx(-0.5));
  const Chart cosine = chart_of("probe.cosine_error");  // R (1 - cos 20 degrees), R = 1 and 2 mm
  CHECK(value_at(cosine.series[1], 20) == doctest::Approx(2e3 * (1 - std::cos(kPi / 9))));
  const Chart lobing = chart_of("probe.pretravel_lobing");  // 100 mm: 8 um range on the equator
  const auto [low, high] = std::minmax_element(lobing.series[0].y.begin(), lobing.series[0].y.end());
  CHECK(*high - *low == doctest::Approx(8).epsilon(0.01));
}

TEST_CASE("a new effect has a figure without saying anything of it") {
  static constexpr EffectParameter kSize[] = {
      {.name = "size_um_per_kg", .unit = "um/kg", .help = "", .typical = 1e-5, .low = 0, .high = 1, .linear = true}};
  Effect effect;
  effect.name = "part.made_up";
  effect.title = "made up";
  effect.needs = 0u | Covariate::load;
  effect.parameters = kSize;
  effect.displace = made_up;
  const Chart c = signature(effect, machine());
  CHECK(c.x_title == "load on the table, kg");
  CHECK(value_at(c.series.at(0), 1000) == doctest::Approx(10));
}

TEST_CASE("a specification is Vega-Lite 6 with its data and units") {
  const auto spec = nlohmann::json::parse(vega_lite(chart_of("thermal.table_bending")));
  CHECK(spec["$schema"] == "https://vega.github.io/schema/vega-lite/v6.json");
  CHECK(spec["width"] == 480);
  CHECK(spec["height"] == 260);
  CHECK(spec["encoding"]["x"]["axis"]["title"] == "reading of x, mm");
  CHECK(spec["encoding"]["y"]["axis"]["title"] == "r, µm");
  CHECK(spec["encoding"]["color"]["scale"]["domain"] == nlohmann::json({"+z", "+x"}));
  CHECK(spec["data"]["values"].size() > 100);
  CHECK(spec["data"]["values"][0]["series"] == "+z");
}

TEST_CASE("numbers of a specification are rounded") {
  Chart c;
  c.series = {{"", {0.123456789}, {-0.00001}}};
  const auto spec = nlohmann::json::parse(vega_lite(c));
  CHECK(spec["data"]["values"][0]["x"].dump() == "0.1235");
  CHECK(spec["data"]["values"][0]["y"].dump() == "0.0");
  CHECK(!spec["encoding"].contains("color"));
}

}  // namespace abbe
