#include "engine/run/effect_set.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/base/diagnostic.hpp"
#include "engine/lanes/random.hpp"

namespace abbe {

namespace {

// Sites of the numbers that an effect draws; ordinals of touches stay below.
constexpr std::uint32_t kParameterSite = 0x80000000u, kMachineSite = 0x40000000u, kVisitSite = 0x20000000u;
constexpr int kMostNumbers = 64;

std::string did_you_mean(std::string_view name, const std::vector<std::string_view>& candidates, std::string otherwise) {
  const std::string near = nearest_word(name, candidates);
  return near.empty() ? otherwise : "did you mean '" + near + "'?";
}

const Effect& registered(const std::string& name, const std::string& machine) {
  if (const Effect* effect = find_effect(name)) return *effect;
  std::vector<std::string_view> names;
  for (const Effect* e : effects()) names.push_back(e->name);
  throw UserError(diagnostic(Code::E0305, fmt::format("machine '{}' asks for an unknown effect '{}'", machine, name),
                             did_you_mean(name, names, "`abbe explain effects` lists them")));
}

int parameter_index(const Effect& effect, const std::string& name, const std::string& machine) {
  std::vector<std::string_view> names;
  for (const EffectParameter& p : effect.parameters) {
    if (p.name == name) return static_cast<int>(names.size());
    names.push_back(p.name);
  }
  throw UserError(diagnostic(Code::E0306, fmt::format("effect '{}' of machine '{}' has no parameter '{}'", effect.name, machine, name),
                             did_you_mean(name, names, fmt::format("it has: {}", fmt::join(names, ", ")))));
}

/// The code of a parameter that is given as a word ("axis": "x").
double code_of(const EffectParameter& parameter, const std::string& word, const Effect& effect, const std::string& machine) {
  const auto found = std::find(parameter.choices.begin(), parameter.choices.end(), word);
  if (found != parameter.choices.end()) return parameter.low + static_cast<double>(found - parameter.choices.begin());
  throw UserError(diagnostic(Code::E0307,
                             fmt::format("{}={} of effect '{}' (machine '{}') is not a value it can have", parameter.name, word, effect.name, machine),
                             parameter.choices.empty() ? "give a number" : fmt::format("give one of: {}", fmt::join(parameter.choices, ", "))));
}

}  // namespace

EffectSet::EffectSet(const std::vector<EffectSetting>& settings, EffectUse use, const std::string& machine) : use_(use) {
  for (const EffectSetting& setting : settings) {
    const Effect& effect = registered(setting.name, machine);
    Active a{&effect, stream_of(effect.name), {}, {}, effect.draws_per == DrawsPer::none};
    for (const EffectParameter& p : effect.parameters) a.value.push_back(p.standard);
    a.u.assign(effect.parameters.size(), 0.0);
    for (const auto& [name, value] : setting.parameters) {
      const int p = parameter_index(effect, name, machine);
      const EffectParameter& parameter = effect.parameters[p];
      a.value[p] = value.word.empty() ? value.value : code_of(parameter, value.word, effect, machine);
      if (a.value[p] < parameter.low || a.value[p] > parameter.high) {
        throw UserError(diagnostic(Code::E0307,
                                   fmt::format("{}={:g} of effect '{}' (machine '{}') is not plausible", name, value.value, effect.name, machine),
                                   fmt::format("give a value from {:g} to {:g} {}", parameter.low, parameter.high, parameter.unit)));
      }
      a.u[p] = value.u;
      if (value.u != 0 && !parameter.linear) a.linear = false;
    }
    active_.push_back(std::move(a));
  }
}

EffectSet::LaneParameters EffectSet::draw(std::uint64_t seed, const std::vector<std::uint32_t>& machines) const {
  LaneParameters lanes;
  lanes.lanes = static_cast<int>(machines.size());
  for (const Active& a : active_) {
    std::vector<double> theta, draws;
    for (std::uint32_t p = 0; p < a.value.size(); ++p) {
      const EffectParameter& parameter = a.effect->parameters[p];
      for (const std::uint32_t m : machines) {
        const double drawn = a.value[p] + a.u[p] * normal_quantile(uniform_pair({seed, m, a.stream, kParameterSite | p, 0, 0}).a);
        // A period or a time constant outside its plausible range has no meaning; a size has.
        theta.push_back(parameter.linear ? drawn : std::clamp(drawn, parameter.low, parameter.high));
      }
    }
    if (a.effect->draws_per == DrawsPer::machine)
      for (int k = 0; k < a.effect->draws; ++k)
        for (const std::uint32_t m : machines)
          draws.push_back(normal_quantile(uniform_pair({seed, m, a.stream, kMachineSite, 0, static_cast<std::uint32_t>(k)}).a));
    lanes.theta.push_back(std::move(theta));
    lanes.machine_draws.push_back(std::move(draws));
  }
  return lanes;
}

void EffectSet::add(int k, const Group& group, const LaneParameters& lanes, std::uint64_t seed, std::uint32_t site, TouchBatch& batch) const {
  for (int e = k < 0 ? 0 : k; e < (k < 0 ? size() : k + 1); ++e) {
    if (active_[e].linear)
      add_linear(active_[e], group, lanes.theta[e], lanes.lanes, batch);
    else
      add_sampled(e, group, lanes, seed, site, batch);
  }
}

void EffectSet::add_linear(const Active& a, const Group& group, const std::vector<double>& theta, int lanes, TouchBatch& batch) const {
  const auto add_column = [&](const Vec3& per_unit, auto size_of) {
    for (const int slot : group.slots) batch.error.set(slot, batch.error.get(slot) + size_of(batch.lane[slot]) * per_unit);
  };
  if (use_ == EffectUse::left_in) add_column(a.effect->displace(*group.scene, a.value.data(), nullptr), [](int) { return 1.0; });
  double unit[kMostNumbers];
  ABBE_CHECK(a.value.size() <= kMostNumbers);
  for (std::size_t p = 0; p < a.value.size(); ++p) {
    if (a.u[p] == 0) continue;
    for (std::size_t q = 0; q < a.value.size(); ++q) unit[q] = q == p ? 1.0 : a.effect->parameters[q].linear ? 0.0 : a.value[q];
    const double* column = theta.data() + p * static_cast<std::size_t>(lanes);
    add_column(a.effect->displace(*group.scene, unit, nullptr), [&](int lane) { return column[lane] - a.value[p]; });
  }
}

void EffectSet::add_sampled(int k, const Group& group, const LaneParameters& lanes, std::uint64_t seed, std::uint32_t site,
                            TouchBatch& batch) const {
  const Active& a = active_[k];
  const int parameters = static_cast<int>(a.value.size()), draws = a.effect->draws;
  ABBE_CHECK(parameters <= kMostNumbers && draws <= kMostNumbers);
  double theta[kMostNumbers], z[kMostNumbers] = {};
  // A correction takes out the estimate; what an effect draws at random cannot be corrected.
  const bool subtract = use_ == EffectUse::corrected && a.effect->draws_per == DrawsPer::none;
  const Vec3 estimate = subtract ? a.effect->displace(*group.scene, a.value.data(), z) : Vec3{};
  for (std::size_t i = 0; i < group.slots.size(); ++i) {
    const int slot = group.slots[i], lane = batch.lane[slot];
    for (int p = 0; p < parameters; ++p) theta[p] = lanes.theta[k][static_cast<std::size_t>(p) * lanes.lanes + lane];
    for (int j = 0; j < draws; ++j) {
      const auto number = static_cast<std::uint32_t>(j);
      switch (a.effect->draws_per) {
        case DrawsPer::none: break;
        case DrawsPer::machine: z[j] = lanes.machine_draws[k][static_cast<std::size_t>(j) * lanes.lanes + lane]; break;
        case DrawsPer::visit:
          z[j] = normal_quantile(uniform_pair({seed, batch.machine[slot], a.stream, kVisitSite, group.indexings[i], number}).a);
          break;
        case DrawsPer::touch:
          z[j] = normal_quantile(uniform_pair({seed, batch.machine[slot], a.stream, site, batch.visit[slot], number}).a);
          break;
      }
    }
    batch.error.set(slot, batch.error.get(slot) + a.effect->displace(*group.scene, theta, z) - estimate);
  }
}

}  // namespace abbe
