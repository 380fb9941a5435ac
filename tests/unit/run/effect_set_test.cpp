// EffectSet::add against the plain evaluation of every effect, lane by lane.
#include "engine/run/effect_set.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/lanes/random.hpp"
#include "tests/unit/effects/random_scene.hpp"

using namespace abbe;
using effects_test::Numbers;
using effects_test::random_scene;

namespace {

constexpr std::uint64_t kSeed = 7;
constexpr std::uint32_t kSite = 3, kVisitSite = 0x20000000u;
constexpr int kMachines = 11;

enum class UncertainParameters { nothing, sizes, everything };

/// Every parameter inside its range (so that no value needs to be cut there), some of them uncertain.
EffectSetting setting_of(const Effect& effect, UncertainParameters uncertain) {
  EffectSetting setting{std::string(effect.name), {}};
  for (const EffectParameter& p : effect.parameters) {
    const double value = !p.is_code() ? 0.5 * (p.typical + p.standard) : p.standard;
    const bool doubtful = uncertain == UncertainParameters::everything
        ? !p.is_code()
        : uncertain == UncertainParameters::sizes && p.linear;
    const double u = doubtful ? 1e-3 * (p.high - p.low) : 0;
    setting.parameters[std::string(p.name)] = {std::clamp(value, p.low, p.high), u, ""};
  }
  return setting;
}

std::vector<EffectSetting> all_settings(UncertainParameters uncertain) {
  std::vector<EffectSetting> settings;
  for (const Effect* effect : effects()) settings.push_back(setting_of(*effect, uncertain));
  return settings;
}

std::vector<std::uint32_t> machines_from(std::uint32_t first, int count) {
  std::vector<std::uint32_t> machines(count);
  std::iota(machines.begin(), machines.end(), first);
  return machines;
}

/// A touch of some lanes of a block.
struct Case {
  TouchScene scene;
  TouchBatch batch;
  EffectSet::Group group;
};

/// Machine m is on its visit m % 3, its head in indexing m % 2.
Case case_of(const TouchScene& scene, const std::vector<int>& lanes, const std::vector<std::uint32_t>& machines) {
  Case c{scene, {}, {}};
  c.group.seed = kSeed, c.group.site = kSite;
  c.batch.resize(static_cast<int>(lanes.size()));
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    const std::uint32_t m = machines[lanes[i]];
    c.batch.lane[i] = lanes[i];
    c.batch.machine[i] = m;
    c.batch.visit[i] = m % 3;
    const int slot = static_cast<int>(i);
    c.batch.error.set(slot, {});
    c.batch.surface.set(slot, {});  // where the part is does not matter, nor the size of the tip
    c.batch.surface_normal.set(slot, scene.normal);
    c.batch.normal.set(slot, scene.normal);
    c.batch.radius[slot] = 0;
    c.batch.commanded.set(slot, {});
    c.group.slots.push_back(static_cast<int>(i));
    c.group.indexings.push_back(m % 2);
  }
  return c;
}

/// Draw j of a visit or a touch, by its address.
double draw(const Effect& effect, std::uint32_t machine, std::uint32_t site, std::uint32_t visit, std::uint32_t j) {
  const UniformPair u = uniform_pair({kSeed, machine, stream_of(effect.name), site, visit, j / 2});
  return normal_quantile(j % 2 == 0 ? u.a : u.b);
}

bool sees_reading(const Effect& effect) { return (effect.needs & static_cast<unsigned>(Covariate::raw_reading)) != 0; }

/// Effect k of the set on one slot, as effect.hpp describes it.
Vec3 plain(const EffectSet& set, int k, const EffectSet::LaneParameters& drawn, const Case& c, int slot,
           const EffectSetting* taken_out, const Vec3& other_errors = {}) {
  const Effect& effect = set.effect(k);
  TouchScene scene = c.scene;
  // The machine stops where all other errors have brought it along the normal.
  if (sees_reading(effect)) scene.reading += dot(scene.normal, other_errors) * scene.normal;
  const auto lane = static_cast<std::size_t>(c.batch.lane[slot]), width = static_cast<std::size_t>(drawn.lanes);
  std::vector<double> theta, z, estimate;
  for (std::size_t p = 0; p < effect.parameters.size(); ++p) {
    theta.push_back(drawn.theta[k][p * width + lane]);
    if (taken_out) estimate.push_back(taken_out->parameters.at(std::string(effect.parameters[p].name)).value);
  }
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(effect.draws); ++j) {
    const std::uint32_t m = c.batch.machine[slot];
    z.push_back(effect.draws_per == DrawsPer::machine     ? drawn.machine_draws[k][j * width + lane]
                    : effect.draws_per == DrawsPer::visit ? draw(effect, m, kVisitSite, c.group.indexings[slot], j)
                                                          : draw(effect, m, kSite, c.batch.visit[slot], j));
  }
  const Vec3 d = effect.displace(scene, theta.data(), z.data());
  const bool subtract = taken_out && effect.draws_per == DrawsPer::none;
  return subtract ? d - effect.displace(scene, estimate.data(), z.data()) : d;
}

void compare_with_plain(UncertainParameters uncertain, EffectUse use, const std::vector<int>& lanes) {
  const std::vector<EffectSetting> settings = all_settings(uncertain);
  const EffectSet set(settings, use, "test");
  const auto machines = machines_from(100, kMachines);
  const auto drawn = set.draw(kSeed, machines);
  Numbers random(1);
  for (int scene = 0; scene < 10; ++scene) {
    const TouchScene where = random_scene(random);
    Case all = case_of(where, lanes, machines);
    all.group.scene = &all.scene;
    EffectActivities together = set.none_active();
    set.add({}, all.group, drawn, all.batch, together);
    std::vector<Vec3> total(lanes.size());
    double largest = 0;
    for (int k = 0; k < set.size(); ++k) {
      CAPTURE(set.effect(k).name);
      Case one = case_of(where, lanes, machines);
      one.group.scene = &one.scene;
      EffectActivities acted = set.none_active();
      set.add(k, one.group, drawn, one.batch, acted);
      bool moved = false;
      for (int slot = 0; slot < one.batch.n; ++slot) {
        const Vec3 expected = plain(set, k, drawn, one, slot, use == EffectUse::corrected ? &settings[k] : nullptr);
        CHECK(norm(one.batch.error.get(slot) - expected) <= 1e-15 * std::fmax(1, norm(expected)));
        if (!sees_reading(set.effect(k))) total[slot] += expected;
        largest = std::fmax(largest, norm(expected));
        moved = moved || std::fabs(dot(where.normal, expected)) > 1e-9;
      }
      CHECK(acted[k].moved == moved);
      CHECK(std::count_if(acted.begin(), acted.end(), [](const EffectActivity& a) { return a.moved; }) ==
            (moved ? 1 : 0));
      if (!sees_reading(set.effect(k))) CHECK(together[k].moved == acted[k].moved);
    }
    for (int slot = 0; slot < all.batch.n; ++slot) {
      const Vec3 others = total[slot];
      for (int k = 0; k < set.size(); ++k)
        if (sees_reading(set.effect(k)))
          total[slot] += plain(set, k, drawn, all, slot, use == EffectUse::corrected ? &settings[k] : nullptr, others);
    }
    for (int slot = 0; slot < all.batch.n; ++slot)
      CHECK(norm(all.batch.error.get(slot) - total[slot]) <= 1e-15 * std::fmax(1, 10 * largest));
  }
}

}  // namespace

TEST_CASE("effect set: every effect is what displace() says, lane by lane") {
  const std::vector<int> together = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, middle = {4, 5, 6},
                         scattered = {0, 3, 4, 7, 10}, one = {9};
  for (const UncertainParameters uncertain :
       {UncertainParameters::nothing, UncertainParameters::sizes, UncertainParameters::everything})
    for (const EffectUse use : {EffectUse::left_in, EffectUse::corrected})
      for (const auto* lanes : {&together, &middle, &scattered, &one}) {
        CAPTURE(static_cast<int>(uncertain));
        CAPTURE(static_cast<int>(use));
        CAPTURE(lanes->size());
        compare_with_plain(uncertain, use, *lanes);
      }
}

TEST_CASE("effect set: a machine has the same errors in any block, to the bit") {
  const EffectSet set(all_settings(UncertainParameters::sizes), EffectUse::left_in, "test");
  Numbers random(2);
  const TouchScene where = random_scene(random);
  const auto errors = [&](std::uint32_t first, int count) {
    const auto machines = machines_from(first, count);
    std::vector<int> lanes(count);
    std::iota(lanes.begin(), lanes.end(), 0);
    Case c = case_of(where, lanes, machines);
    c.group.scene = &c.scene;
    EffectActivities acted = set.none_active();
    set.add({}, c.group, set.draw(kSeed, machines), c.batch, acted);
    return c.batch.error;
  };
  const Columns3 whole = errors(100, kMachines), left = errors(100, 4), right = errors(104, kMachines - 4);
  for (int i = 0; i < kMachines; ++i) CHECK(whole.get(i) == (i < 4 ? left.get(i) : right.get(i - 4)));
}

TEST_CASE("effect set: a period drawn beyond its plausible range is the nearest in it, a size is as it was drawn") {
  EffectSetting cycle{"thermal.cycle", {{"period_s", {150, 100, ""}}, {"amplitude_um", {1, 2000, ""}}}};
  const Effect& effect = *find_effect(cycle.name);
  std::vector<std::uint32_t> machines(100);
  std::iota(machines.begin(), machines.end(), 0u);
  const EffectSet set({cycle}, EffectUse::left_in, "m");
  const std::vector<double> theta = set.draw(kSeed, machines).theta[0];
  const auto least = [&](std::size_t parameter) {
    return *std::min_element(theta.begin() + static_cast<std::ptrdiff_t>(100 * parameter),
                             theta.begin() + static_cast<std::ptrdiff_t>(100 * parameter + 100));
  };
  REQUIRE(effect.parameters[0].name == "amplitude_um");
  REQUIRE(effect.parameters[1].name == "period_s");
  CHECK(least(1) == 120);
  CHECK(least(0) < -1000);
}

TEST_CASE("effect set: one standard deviation of a parameter moves a recorded touch by its share") {
  RecordedTouch touch;
  touch.scene.reading = {500, 0, 0};
  const EffectSet set({{"machine.scale", {{"scale_um_per_m", {5, 2, ""}}}}}, EffectUse::left_in, "m");
  REQUIRE(set.uncertainties().size() == 1);
  CHECK(set.one_sd(set.uncertainties()[0], touch).x == doctest::Approx(1e-3).scale(0));  // 2 um/m over 500 mm
  CHECK(set.estimate(touch).x == doctest::Approx(2.5e-3).scale(0));
}

TEST_CASE("effect set: numbers do not depend on which other effects exist") {
  const std::vector<EffectSetting> settings = all_settings(UncertainParameters::everything);
  const auto machines = machines_from(100, kMachines);
  const auto together = EffectSet(settings, EffectUse::left_in, "test").draw(kSeed, machines);
  for (std::size_t k = 0; k < settings.size(); ++k) {
    CAPTURE(settings[k].name);
    const auto alone = EffectSet({settings[k]}, EffectUse::left_in, "test").draw(kSeed, machines);
    CHECK(alone.theta[0] == together.theta[k]);
    CHECK(alone.machine_draws[0] == together.machine_draws[k]);
    CHECK(alone.weights[0] == together.weights[k]);
  }
}

TEST_CASE("effect set: two settings of one effect draw their own numbers, and the first the same as alone") {
  const auto machines = machines_from(100, kMachines);
  const std::vector<int> lanes{0, 1, 2};
  Numbers random(3);
  const TouchScene where = random_scene(random);
  const auto errors = [&](const std::vector<EffectSetting>& settings, int k) {
    const EffectSet set(settings, EffectUse::left_in, "test");
    Case c = case_of(where, lanes, machines);
    c.group.scene = &c.scene;
    EffectActivities acted = set.none_active();
    set.add(k, c.group, set.draw(kSeed, machines), c.batch, acted);
    return c.batch.error;
  };
  for (const char* name : {"machine.scale", "noise.vibration", "head.reindexing", "head.axis_errors"}) {
    CAPTURE(name);
    EffectSetting setting = setting_of(*find_effect(name), UncertainParameters::sizes);
    setting.parameters["axis"] = {0, 0, "x"};
    if (setting.name != "machine.scale") setting.parameters.erase("axis");
    const Columns3 alone = errors({setting}, 0), first = errors({setting, setting}, 0),
                   second = errors({setting, setting}, 1);
    for (const int i : lanes) {
      CHECK(first.get(i) == alone.get(i));
      CHECK(norm(second.get(i) - first.get(i)) > 0);
    }
  }
}

TEST_CASE("effect set: an effect acts once it moves a touch along its normal") {
  const auto machines = machines_from(100, kMachines);
  const EffectSet set({{"machine.scale", {{"axis", {0, 0, "x"}}, {"scale_um_per_m", {10, 0, ""}}}}}, EffectUse::left_in,
                      "test");
  const auto acted = [&](EffectActivities before, const Vec3& normal) {
    Case c = case_of({}, {0, 1}, machines);
    c.scene.reading = {500, 500, 500};
    c.scene.normal = normal;
    c.group.scene = &c.scene;
    set.add({}, c.group, set.draw(kSeed, machines), c.batch, before);
    return before[0].moved;
  };
  CHECK_FALSE(acted({{}}, {0, 1, 0}));
  CHECK(acted({{}}, {1, 0, 0}));
  CHECK(acted({{.moved = true}}, {0, 1, 0}));  // earlier touches count
}
