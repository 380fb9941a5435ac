// Over the whole registry: every effect can be asked for in a machine file, and none changes a number of another.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/effects/effect.hpp"
#include "tests/unit/run/plan_builder.hpp"

using namespace abbe;
using namespace abbe::test;

namespace {

const Machine& machine() {
  static const Machine m = read_machine("coord3-mc16");
  return m;
}

/// Coordinates of two touches, each with the head at its own orientation.
plan::Plan coordinates() {
  PlanBuilder b;
  const auto first = b.sensor(30, 90, 150), second = b.sensor(60, 90, 150);
  Arguments a;
  a.add_text("mode", "NOMINL");
  a.add_number("nominal", 0);
  a.add_number("lower", -1);
  a.add_number("upper", 1);
  a.add_text("axis", "YAXIS");
  b.append(plan::SelectSensor{first});
  const auto p = b.point({800, 400, -500}, {0, -1, 0});
  b.append(plan::SelectSensor{second});
  const auto q = b.point({800, 600, -500}, {0, 1, 0});
  b.evaluate({p, q}, "DISTB", a);
  return b.plan;
}

std::vector<double> values(const Machine& m) {
  static const SourceFile source("test", "");
  static const VirtualMachines machines = screened_machines(machine(), 1, 20, 1);
  RunOptions options;
  return run_plan(coordinates(), m, machines, options, source).samples.at(0).value;
}

Machine with(std::vector<EffectSetting> effects) {
  Machine m = machine();
  m.effects = std::move(effects);
  return m;
}

bool has_linear(const Effect& effect) {
  return std::any_of(effect.parameters.begin(), effect.parameters.end(),
                     [](const EffectParameter& p) { return p.linear; });
}

/// The effect with its sizes at `share` of what is typical.
EffectSetting sized(const Effect& effect, double share) {
  EffectSetting setting;
  setting.name = effect.name;
  for (const EffectParameter& p : effect.parameters)
    if (p.linear || !has_linear(effect)) setting.parameters[std::string(p.name)] = {share * p.typical, 0, ""};
  return setting;
}

}  // namespace

TEST_CASE("an effect of size zero changes no bit of a result") {
  const std::vector<double> without = values(machine());
  for (const Effect* effect : effects()) {
    CAPTURE(effect->name);
    CHECK(values(with({sized(*effect, 0)})) == without);
  }
}

TEST_CASE("what an effect adds does not depend on the effects beside it") {
  const auto all = effects();
  const std::vector<double> without = values(machine());
  std::vector<std::vector<double>> alone;
  for (const Effect* effect : all) alone.push_back(values(with({sized(*effect, 1)})));
  const auto check_pair = [&](std::size_t i, std::size_t j) {
    CAPTURE(all[i]->name);
    CAPTURE(all[j]->name);
    const auto both = values(with({sized(*all[j], 1), sized(*all[i], 1)}));
    REQUIRE(both.size() == without.size());
    for (std::size_t k = 0; k < both.size(); ++k)
      CHECK(std::fabs((both[k] - alone[j][k]) - (alone[i][k] - without[k])) < 1e-12);
  };
  for (std::size_t i = 0; i < all.size(); ++i) check_pair(i, (i + 1) % all.size());

  // One of each family and each way of drawing numbers, among those that act here, against every other: the
  // rest need what this program does not have, a load, a temperature, a later time.
  std::vector<std::size_t> representatives;
  std::set<std::pair<std::string_view, DrawsPer>> seen;
  std::set<std::string_view> families;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string_view family = all[i]->name.substr(0, all[i]->name.find('.'));
    if (alone[i] == without || !seen.insert({family, all[i]->draws_per}).second) continue;
    representatives.push_back(i);
    families.insert(family);
  }
  CHECK(families.size() == 6);
  CHECK(representatives.size() > 8);
  for (const std::size_t i : representatives)
    for (const std::size_t j : representatives)
      if (i < j) check_pair(i, j);
}

TEST_CASE("a machine file may ask for every effect, by its first parameter") {
  std::ifstream stream(ABBE_SOURCE_DIR "/examples/machines/coord3-mc16.json");
  nlohmann::json file = nlohmann::json::parse(stream);
  for (const Effect* effect : effects()) {
    CAPTURE(effect->name);
    const EffectParameter& first = effect->parameters[0];
    file["effects"] = {{{"name", effect->name}, {"parameters", {{first.name, {{"value", first.typical}, {"u", 0}}}}}}};
    const Machine m = parse_machine("m.json", file.dump());
    REQUIRE(m.effects.size() == 1);
    CHECK(m.effects[0].parameters.at(std::string(first.name)).value == first.typical);
    CHECK(values(m).size() == 20);
  }
}
