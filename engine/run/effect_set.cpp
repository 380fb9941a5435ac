#include "engine/run/effect_set.hpp"

#include <algorithm>
#include <cmath>

#include "engine/lanes/random.hpp"
#include "engine/lanes/weighted_sum.hpp"
#include "engine/machine/effect_names.hpp"
#include "engine/math/normal.hpp"
#include "engine/run/effect_settings.hpp"

namespace abbe {

namespace {

// Sites of the numbers that an effect draws; ordinals of touches stay below.
constexpr std::uint32_t kParameterSite = 0x80000000u, kMachineSite = 0x40000000u, kVisitSite = 0x20000000u;
constexpr int kMostNumbers = 64;

/// Whether d shows: only along the normal, and not below the rounding of coordinates of about a metre.
bool shows(double along_normal_mm) { return std::fabs(along_normal_mm) >= 1e-9; }

/// `count` standard normal numbers for every machine: [draw][machine].
std::vector<double> normal_numbers(int count, std::uint64_t seed, const std::vector<std::uint32_t>& machine,
                                   std::uint32_t stream, std::uint32_t site, const std::vector<std::uint32_t>& visit) {
  const std::size_t n = machine.size();
  std::vector<double> z((count + 1) / 2 * 2 * n);
  for (int pair = 0; 2 * pair < count; ++pair) {
    double* first = z.data() + 2 * pair * n;
    normal_pairs(static_cast<int>(n), seed, machine.data(), stream, site, visit.data(),
                 static_cast<std::uint32_t>(pair), first, first + n);
  }
  return z;
}

}  // namespace

EffectSet::EffectSet(const std::vector<EffectSetting>& settings, EffectUse use, const std::string& machine) {
  const std::vector<std::string> names = effect_names(settings);
  for (std::size_t k = 0; k < settings.size(); ++k) {
    const ResolvedEffect resolved = resolve(settings[k], machine);
    Active a{resolved.effect, stream_of(names[k]), resolved.value, resolved.u, false, false, {}};
    // What an effect draws at random cannot be corrected.
    a.corrected = use == EffectUse::corrected && a.effect->draws_per == DrawsPer::none;
    a.linear = is_linear(a);
    if (a.linear) a.components = components_of(a);
    active_.push_back(std::move(a));
  }
}

bool EffectSet::is_linear(const Active& a) {
  for (std::size_t p = 0; p < a.u.size(); ++p)
    if (a.u[p] != 0 && !a.effect->parameters[p].linear) return false;
  return a.effect->draws == 0 || a.effect->linear_in_draws;
}

bool EffectSet::sees_temperatures(const Active& a) {
  return (a.effect->needs & (Covariate::part_temperature | Covariate::scale_temperature)) != 0;
}

bool EffectSet::sees_temperatures() const {
  return std::any_of(active_.begin(), active_.end(), [](const Active& a) { return sees_temperatures(a); });
}

std::vector<EffectSet::Component> EffectSet::components_of(const Active& a) {
  std::vector<double> zero = a.value, certain = a.value;
  for (std::size_t p = 0; p < zero.size(); ++p) {
    if (a.effect->parameters[p].linear) zero[p] = 0;
    if (a.u[p] != 0) certain[p] = 0;
  }
  std::vector<Component> components;
  for (std::size_t p = 0; p < zero.size(); ++p) {
    if (a.u[p] == 0) continue;
    components.push_back({zero, static_cast<int>(p)});
    components.back().theta[p] = 1;
  }
  // Where all certain sizes are zero, they do nothing. (An effect may have no linear parameter: then nothing
  // is uncertain either.)
  if (!a.corrected && (components.empty() || certain != zero)) components.push_back({certain, -1});
  return components;
}

std::vector<double> EffectSet::weights(const Active& a, const std::vector<double>& theta,
                                       const std::vector<double>& machine_draws, int lanes) {
  std::vector<double> weights;
  for (const Component& component : a.components) {
    std::vector<double> column(lanes, 1.0);
    if (component.parameter >= 0) {
      const double* of_parameter = theta.data() + static_cast<std::size_t>(component.parameter) * lanes;
      for (int i = 0; i < lanes; ++i) column[i] = of_parameter[i] - (a.corrected ? a.value[component.parameter] : 0);
    }
    if (a.effect->draws_per == DrawsPer::machine) {
      for (int i = 0; i < a.effect->draws * lanes; ++i) weights.push_back(column[i % lanes] * machine_draws[i]);
    } else {
      weights.insert(weights.end(), column.begin(), column.end());
    }
  }
  return weights;
}

Vec3 EffectSet::estimate(const RecordedTouch& touch) const {
  const double none[kMostNumbers] = {};
  Vec3 d;
  for (const Active& a : active_) d += a.effect->displace(scene_for(*a.effect, touch), a.value.data(), none);
  return d;
}

std::vector<EffectSet::Uncertainty> EffectSet::uncertainties() const {
  std::vector<Uncertainty> list;
  for (int e = 0; e < size(); ++e) {
    const Active& a = active_[e];
    for (std::size_t p = 0; p < a.u.size(); ++p)
      if (a.u[p] != 0) list.push_back({e, static_cast<int>(p)});
    for (int j = 0; j < a.effect->draws; ++j) list.push_back({e, -1, j, a.effect->draws_per});
  }
  return list;
}

Vec3 EffectSet::one_sd(const Uncertainty& of, const RecordedTouch& touch) const {
  const Active& a = active_[of.effect];
  const TouchScene scene = scene_for(*a.effect, touch);
  std::vector<double> value = a.value;
  double draws[kMostNumbers] = {};
  const Vec3 estimate = a.effect->displace(scene, value.data(), draws);
  if (of.parameter >= 0) value[of.parameter] += a.u[of.parameter];
  if (of.draw < 0 || a.effect->linear_in_draws) {
    if (of.draw >= 0) draws[of.draw] = 1;
    return a.effect->displace(scene, value.data(), draws) - estimate;
  }
  constexpr int kQuantiles = 100;
  Vec3 sum, squares;
  for (int k = 0; k < kQuantiles; ++k) {
    draws[of.draw] = normal_quantile((k + 0.5) / kQuantiles);
    const Vec3 d = a.effect->displace(scene, value.data(), draws);
    sum += d;
    for (int i = 0; i < 3; ++i) squares[i] += d[i] * d[i];
  }
  Vec3 sd;
  for (int i = 0; i < 3; ++i)
    sd[i] = std::copysign(std::sqrt(std::max(0.0, squares[i] / kQuantiles - std::pow(sum[i] / kQuantiles, 2))),
                          a.effect->displace(scene, value.data(), draws)[i]);
  return sd;
}

EffectSet::LaneParameters EffectSet::draw(std::uint64_t seed, const std::vector<std::uint32_t>& machines) const {
  LaneParameters lanes;
  lanes.lanes = static_cast<int>(machines.size());
  for (const Active& a : active_) {
    std::vector<double> theta, draws;
    for (std::uint32_t p = 0; p < a.value.size(); ++p) {
      const EffectParameter& parameter = a.effect->parameters[p];
      for (const std::uint32_t m : machines) {
        const double drawn =
            a.value[p] + a.u[p] * normal_quantile(uniform_pair({seed, m, a.stream, kParameterSite | p, 0, 0}).a);
        // A period or a time constant outside its plausible range has no meaning; a size has.
        theta.push_back(parameter.linear ? drawn : std::clamp(drawn, parameter.low, parameter.high));
      }
    }
    if (a.effect->draws_per == DrawsPer::machine)
      draws = normal_numbers(a.effect->draws, seed, machines, a.stream, kMachineSite,
                             std::vector<std::uint32_t>(machines.size()));
    lanes.weights.push_back(weights(a, theta, draws, lanes.lanes));
    lanes.theta.push_back(std::move(theta));
    lanes.machine_draws.push_back(std::move(draws));
  }
  return lanes;
}

/// The machines of a group, in its order, and what the effects add to them.
struct EffectSet::Sum {
  Sum(const Group& g, const TouchBatch& batch, int lane_count)
      : group(g), n(static_cast<int>(g.slots.size())), lanes(lane_count) {
    for (const int slot : g.slots) {
      lane.push_back(batch.lane[slot]);
      machine.push_back(batch.machine[slot]);
      visit.push_back(batch.visit[slot]);
    }
    for (auto& c : error.column) c.assign(n, 0.0);
  }
  /// Row `row` of a table [row][lane], for the machines of the group.
  const double* row_of(const std::vector<double>& table, std::size_t row) {
    const double* by_lane = table.data() + row * static_cast<std::size_t>(lanes);
    if (lane.back() - lane.front() == n - 1) return by_lane + lane.front();  // lanes ascend
    std::vector<double> gathered(n);
    for (int i = 0; i < n; ++i) gathered[i] = by_lane[lane[i]];
    return keep(std::move(gathered));
  }
  const double* keep(std::vector<double> column) { return columns.emplace_back(std::move(column)).data(); }

  const Group& group;
  int n, lanes;
  std::vector<int> lane;
  std::vector<std::uint32_t> machine, visit;
  Columns3 error;                            ///< of the sampled effects
  std::vector<WeightedVector> terms;         ///< of the linear effects
  std::vector<std::vector<double>> columns;  ///< that outlive the terms which point to them
};

void EffectSet::add(std::optional<int> only, const Group& group, const LaneParameters& lanes, TouchBatch& batch,
                    EffectActivities& activities) const {
  if (group.slots.empty()) return;
  std::vector<int> anywhere, by_reading;
  for (int e = only.value_or(0); e < (only ? *only + 1 : size()); ++e)
    (needs_raw_reading(*active_[e].effect) ? by_reading : anywhere).push_back(e);
  if (!anywhere.empty()) add_alike(anywhere, group, lanes, batch, activities);
  if (by_reading.empty()) return;
  find_contact(batch);
  add_alike(by_reading, group, lanes, batch, activities);
}

void EffectSet::add_alike(const std::vector<int>& which, const Group& group, const LaneParameters& lanes,
                          TouchBatch& batch, EffectActivities& activities) const {
  Sum sum(group, batch, lanes.lanes);
  for (const int e : which) {
    const Active& a = active_[e];
    if (a.effect->beyond && !activities[e].beyond)
      activities[e].beyond = a.effect->beyond(*group.scene, a.value.data());
    std::vector<double> draws;
    if (a.effect->draws_per == DrawsPer::touch)
      draws = normal_numbers(a.effect->draws, group.seed, sum.machine, a.stream, group.site, sum.visit);
    if (a.effect->draws_per == DrawsPer::visit)
      draws = normal_numbers(a.effect->draws, group.seed, sum.machine, a.stream, kVisitSite, group.indexings);
    const bool own_scenes = needs_raw_reading(*a.effect) || (sees_temperatures(a) && !group.temperatures.empty());
    if (a.linear && !own_scenes)
      add_linear(a, lanes.weights[e], draws, sum, activities[e].moved);
    else
      add_sampled(a, lanes.theta[e], a.effect->draws_per == DrawsPer::machine ? lanes.machine_draws[e] : draws, batch,
                  sum, activities[e].moved);
  }
  auto& [x, y, z] = sum.error.column;
  add_weighted(sum.n, sum.terms, x.data(), y.data(), z.data());
  for (int i = 0; i < sum.n; ++i) batch.error.set(group.slots[i], batch.error.get(group.slots[i]) + sum.error.get(i));
}

void EffectSet::add_linear(const Active& a, const std::vector<double>& weights, const std::vector<double>& draws,
                           Sum& sum, bool& moved) {
  const bool by_machine = a.effect->draws_per == DrawsPer::machine;
  const int terms = std::max(1, a.effect->draws);
  ABBE_CHECK(terms <= kMostNumbers);
  double unit[kMostNumbers] = {};
  for (std::size_t q = 0; q < a.components.size(); ++q) {
    for (int j = 0; j < terms; ++j) {
      unit[j] = 1;
      const Vec3 vector = a.effect->displace(*sum.group.scene, a.components[q].theta.data(), unit);
      unit[j] = 0;
      if (vector == Vec3{}) continue;
      const double* weight = sum.row_of(weights, by_machine ? q * terms + j : q);
      if (!draws.empty()) {
        std::vector<double> product(weight, weight + sum.n);
        for (int i = 0; i < sum.n; ++i) product[i] *= draws[static_cast<std::size_t>(j) * sum.n + i];
        weight = sum.keep(std::move(product));
      }
      const double along = dot(sum.group.scene->normal, vector);
      for (int i = 0; i < sum.n && !moved; ++i) moved = shows(along * weight[i]);
      sum.terms.push_back({vector, weight});
    }
  }
}

void EffectSet::add_sampled(const Active& a, const std::vector<double>& theta, const std::vector<double>& draws,
                            const TouchBatch& batch, Sum& sum, bool& moved) {
  const std::size_t parameters = a.value.size(), numbers = a.effect->draws;
  ABBE_CHECK(numbers <= kMostNumbers);
  const bool by_machine = a.effect->draws_per == DrawsPer::machine;
  std::vector<double> values(parameters);
  double z[kMostNumbers] = {};
  const double none[kMostNumbers] = {};
  TouchScene scene = *sum.group.scene, estimated = scene;
  const auto estimate_there = [&] {
    return a.corrected ? a.effect->displace(estimated, a.value.data(), none) : Vec3{};
  };
  Vec3 estimate = estimate_there();
  for (int i = 0; i < sum.n; ++i) {
    if (!sum.group.temperatures.empty()) scene.temperature = sum.group.temperatures[i];
    if (needs_raw_reading(*a.effect)) {
      const int slot = sum.group.slots[i];
      scene.reading = estimated.reading = sum.group.scene->reading + batch.travel[slot] * batch.normal.get(slot);
      estimate = estimate_there();
    }
    for (std::size_t p = 0; p < parameters; ++p) values[p] = theta[p * sum.lanes + sum.lane[i]];
    for (std::size_t j = 0; j < numbers; ++j)
      z[j] = by_machine ? draws[j * sum.lanes + sum.lane[i]] : draws[j * sum.n + i];
    const Vec3 d = a.effect->displace(scene, values.data(), z);
    if (!moved) moved = shows(dot(scene.normal, d - estimate));
    sum.error.set(i, sum.error.get(i) + d - estimate);
  }
}

}  // namespace abbe
