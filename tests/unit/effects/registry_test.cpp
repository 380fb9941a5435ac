// What every effect must keep, checked over the whole list: a new effect is tested by being listed.
#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "tests/unit/effects/random_scene.hpp"

namespace abbe {

using namespace effects_test;

namespace {

/// Parameters whose names scripts hold on to.
struct FixedParameter {
  std::string_view effect, parameter;
};
constexpr FixedParameter kFixed[] = {
    {"thermal.part_expansion", "cte_error_ppm_per_K"},
    {"thermal.scale_expansion", "cte_error_ppm_per_K"},
    {"machine.scale", "scale_um_per_m"},
    {"machine.scale", "axis"},
    {"machine.squareness", "squareness_urad"},
    {"machine.squareness", "which"},
    {"machine.scale_interpolation", "amplitude_um"},
    {"machine.scale_interpolation", "period_um"},
    {"machine.scale_interpolation", "axis"},
    {"thermal.cycle", "amplitude_um"},
    {"thermal.cycle", "period_s"},
    {"thermal.drift", "amplitude_um"},
    {"thermal.drift", "direction"},
    {"machine.step", "t0_s"},
    {"machine.step", "amplitude_um"},
    {"part.shift", "t0_s"},
    {"part.shift", "amplitude_um"},
    {"probe.step", "t0_s"},
    {"probe.step", "amplitude_um"},
    {"probe.tip_radius", "amplitude_um"},
    {"probe.stylus_length", "length_error_um"},
    {"probe.trigger_delay", "delay_ms"},
    {"head.reindexing", "sd_urad"},
    {"noise.vibration", "sd_um"},
    {"noise.outliers", "share"},
    {"noise.resolution", "resolution_um"},
    {"noise.unequal", "ratio"},
};

std::vector<double> random_draws(const Effect& effect, Numbers& random) {
  std::vector<double> z(static_cast<std::size_t>(effect.draws));
  for (double& value : z) value = random.normal();
  return z;
}

bool has_linear(const Effect& effect) {
  return std::any_of(effect.parameters.begin(), effect.parameters.end(),
                     [](const EffectParameter& p) { return p.linear; });
}

/// Any plausible values; choices fall on their codes.
std::vector<double> random_values(const Effect& effect, Numbers& random) {
  std::vector<double> theta;
  for (const EffectParameter& p : effect.parameters)
    theta.push_back(p.choices.empty() ? random.between(p.low, p.high)
                                      : random.choice(static_cast<int>(p.low), static_cast<int>(p.high)));
  return theta;
}

/// Sizes of one prior standard deviation, everything else at its prior median.
std::vector<double> typical_values(const Effect& effect) {
  std::vector<double> theta;
  for (const EffectParameter& p : effect.parameters) theta.push_back(p.typical);
  return theta;
}

Vec3 displace(const Effect& effect, const TouchScene& scene, const std::vector<double>& theta,
              const std::vector<double>& z) {
  return effect.displace(scene, theta.data(), z.empty() ? nullptr : z.data());
}

bool close(const Vec3& a, const Vec3& b, double size) { return norm(a - b) <= 1e-12 * size; }

constexpr int kScenes = 50;

/// Calls `check` with every effect and some random scenes, values and draws, the same every time.
template <class Check>
void for_all_effects(Check check) {
  for (const Effect* effect : effects()) {
    CAPTURE(effect->name);
    Numbers random(20110412);
    for (int i = 0; i < kScenes; ++i) {
      const TouchScene scene = random_scene(random);
      const std::vector<double> theta = random_values(*effect, random);
      check(*effect, scene, theta, random_draws(*effect, random), random);
    }
  }
}

}  // namespace

TEST_CASE("registry: every name once, found by name") {
  std::set<std::string_view> names;
  for (const Effect* effect : effects()) {
    CHECK_MESSAGE(names.insert(effect->name).second, effect->name << " is listed twice");
    CHECK(find_effect(effect->name) == effect);
  }
  CHECK(find_effect("thermal.part_expansio") == nullptr);
}

TEST_CASE("registry: parameters with published names exist") {
  for (const FixedParameter& fixed : kFixed) {
    CAPTURE(fixed.effect);
    CAPTURE(fixed.parameter);
    const Effect* effect = find_effect(fixed.effect);
    REQUIRE(effect != nullptr);
    CHECK(std::any_of(effect->parameters.begin(), effect->parameters.end(),
                      [&](const EffectParameter& p) { return p.name == fixed.parameter; }));
  }
}

TEST_CASE("registry: every effect explains itself") {
  for (const Effect* effect : effects()) {
    CAPTURE(effect->name);
    CHECK(!effect->title.empty());
    CHECK(effect->help.size() > 80);
    CHECK_MESSAGE(effect->help.find(". ") != std::string_view::npos,
                  "two sentences or more: what it is, and what it does");
    CHECK(effect->help.back() == '.');
    CHECK(!effect->source.empty());
    CHECK(!effect->separate.empty());
    CHECK(effect->needs != 0u);
    CHECK(!effect->parameters.empty());
    CHECK((effect->displace != nullptr));
    CHECK((effect->draws > 0) == (effect->draws_per != DrawsPer::none));
    std::set<std::string_view> names;
    for (const EffectParameter& p : effect->parameters) {
      CAPTURE(p.name);
      CHECK(names.insert(p.name).second);
      CHECK(!p.unit.empty());
      CHECK(p.help.size() > 5);
    }
  }
}

TEST_CASE("registry: plausible ranges contain the standard and the typical value") {
  for (const Effect* effect : effects()) {
    CAPTURE(effect->name);
    for (const EffectParameter& p : effect->parameters) {
      CAPTURE(p.name);
      CHECK(p.low < p.high);
      CHECK(p.low <= p.standard);
      CHECK(p.standard <= p.high);
      CHECK(p.low <= p.typical);
      CHECK(p.typical <= p.high);
      if (p.linear) CHECK(p.typical > 0);
      if (!p.choices.empty()) CHECK(p.choices.size() == p.high - p.low + 1);
    }
  }
}

TEST_CASE("registry: sizes of zero give exactly zero") {
  for_all_effects([](const Effect& effect, const TouchScene& scene, std::vector<double> theta,
                     const std::vector<double>& z, Numbers&) {
    for (std::size_t p = 0; p < theta.size(); ++p)
      if (effect.parameters[p].linear || !has_linear(effect)) theta[p] = 0;
    CHECK(displace(effect, scene, theta, z) == Vec3{});
  });
}

TEST_CASE("registry: the displacement is linear in all linear parameters jointly") {
  for_all_effects([](const Effect& effect, const TouchScene& scene, const std::vector<double>& a,
                     const std::vector<double>& z, Numbers& random) {
    const double s = random.between(-2, 2), t = random.between(-2, 2);
    std::vector<double> b = random_values(effect, random), mixed = a;
    for (std::size_t p = 0; p < a.size(); ++p) {
      if (effect.parameters[p].linear)
        mixed[p] = s * a[p] + t * b[p];
      else
        b[p] = a[p];
    }
    if (!has_linear(effect)) return;
    const Vec3 of_a = displace(effect, scene, a, z), of_b = displace(effect, scene, b, z);
    CHECK(close(displace(effect, scene, mixed, z), s * of_a + t * of_b, 4 * (norm(of_a) + norm(of_b)) + 1e-9));
  });
}

TEST_CASE("registry: the displacement is linear in the draws of every effect that says so") {
  for_all_effects([](const Effect& effect, const TouchScene& scene, const std::vector<double>& theta,
                     const std::vector<double>& a, Numbers& random) {
    CHECK(!(effect.linear_in_draws && effect.draws == 0));
    if (!effect.linear_in_draws) return;
    const double s = random.between(-2, 2), t = random.between(-2, 2);
    const std::vector<double> b = random_draws(effect, random);
    std::vector<double> mixed = a;
    for (std::size_t j = 0; j < a.size(); ++j) mixed[j] = s * a[j] + t * b[j];
    const Vec3 of_a = displace(effect, scene, theta, a), of_b = displace(effect, scene, theta, b);
    CHECK(close(displace(effect, scene, theta, mixed), s * of_a + t * of_b, 4 * (norm(of_a) + norm(of_b)) + 1e-9));
    CHECK(displace(effect, scene, theta, std::vector<double>(a.size())) == Vec3{});
  });
}

TEST_CASE("registry: finite on any plausible scene and values, and the same when asked again") {
  for_all_effects([](const Effect& effect, const TouchScene& scene, const std::vector<double>& theta,
                     const std::vector<double>& z, Numbers&) {
    const Vec3 d = displace(effect, scene, theta, z);
    CHECK(std::isfinite(d.x + d.y + d.z));
    CHECK(displace(effect, scene, theta, z) == d);
  });
}

TEST_CASE("registry: an effect needs what it acts on, so that a recording without it is not judged") {
  struct Change {
    Covariate of;
    void (*make)(TouchScene&, const TouchScene& other);
  };
  // The others may be refinements: what is logged of a gradient, the speed where a choice asks for it.
  const Change changes[] = {
      {Covariate::time, [](TouchScene& s, const TouchScene& other) { s.time_s = other.time_s; }},
      {Covariate::part_temperature,
       [](TouchScene& s, const TouchScene& other) { s.temperature.part = other.temperature.part; }},
      {Covariate::scale_temperature,
       [](TouchScene& s, const TouchScene& other) {
         std::copy(std::begin(other.temperature.scale), std::end(other.temperature.scale), s.temperature.scale);
       }},
      {Covariate::air_temperature,
       [](TouchScene& s, const TouchScene& other) { s.temperature.air = other.temperature.air; }},
      {Covariate::load, [](TouchScene& s, const TouchScene& other) { s.load_kg = other.load_kg; }}};
  for_all_effects([&](const Effect& effect, const TouchScene& scene, const std::vector<double>& theta,
                      const std::vector<double>& z, Numbers& random) {
    for (const Change& change : changes) {
      TouchScene changed = scene;
      change.make(changed, random_scene(random));
      if (displace(effect, changed, theta, z) == displace(effect, scene, theta, z)) continue;
      CAPTURE(static_cast<unsigned>(change.of));
      CHECK((effect.needs & static_cast<unsigned>(change.of)) != 0u);
    }
  });
}

TEST_CASE("registry: finite on a recording that knows next to nothing") {
  TouchScene scene;
  scene.normal = {0, 0, 1};
  for (const Effect* effect : effects()) {
    CAPTURE(effect->name);
    Numbers random(1);
    const Vec3 d = displace(*effect, scene, typical_values(*effect), random_draws(*effect, random));
    CHECK(std::isfinite(d.x + d.y + d.z));
  }
}

TEST_CASE("registry: typical sizes act, and stay below a millimetre") {
  for (const Effect* effect : effects()) {
    CAPTURE(effect->name);
    Numbers random(7);
    double largest = 0;
    for (int i = 0; i < 2000; ++i) {
      const TouchScene scene = random_scene(random);
      const Vec3 d = displace(*effect, scene, typical_values(*effect), random_draws(*effect, random));
      largest = std::max(largest, std::fabs(dot(scene.normal, d)));
    }
    CHECK(largest > 1e-5);
    CHECK(largest < 1);
  }
}

}  // namespace abbe
