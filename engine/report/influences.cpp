#include "engine/report/influences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include "engine/effects/effect.hpp"
#include "engine/math/units.hpp"

namespace abbe {

namespace {

/// What a machine file may have or leave out of what every simulation can hold.
struct MachineInfluence {
  std::string_view name;
  bool (*acts)(const Machine&);
};

bool has_geometric_errors(const Machine& m) {
  return m.squareness_cwy_rad != 0 || m.squareness_bwz_rad != 0 || m.squareness_awz_rad != 0 ||
      std::any_of(m.components.begin(), m.components.end(), [](const ComponentSpec& c) { return c.e_max != 0; });
}

constexpr MachineInfluence kMachineInfluences[] = {
    {"geometry", has_geometric_errors},
    {"head indexing", [](const Machine& m) { return m.head.sd_a_rad > 0 || m.head.sd_b_rad > 0; }},
    {"probe repeatability", [](const Machine& m) { return norm(m.probe.sd_mm) > 0; }},
};

/// What a workpiece file may describe of an influence.
struct PartInfluence {
  std::string_view name;
  bool (*described)(const Workpiece&, const PartInRun&);
};

constexpr PartInfluence kPartInfluences[] = {
    {"part temperature",
     [](const Workpiece& w, const PartInRun& run) { return w.part_temperature_acts(run.temperature_compensated); }},
    {"scale temperature",
     [](const Workpiece& w, const PartInRun& run) { return w.scale_temperature_acts(run.temperature_compensated); }},
    {"true size of the part",
     [](const Workpiece& w, const PartInRun& run) { return w.has_sizes(run.recorded_points); }},
    {"form error of the part",
     [](const Workpiece& w, const PartInRun& run) { return w.has_form(run.recorded_points); }},
};

bool modelled(const InfluenceQuantity& quantity, const Machine& machine, const EffectActivities& activities,
              const Workpiece* workpiece, const PartInRun& run) {
  const auto* own = std::find_if(std::begin(kMachineInfluences), std::end(kMachineInfluences),
                                 [&](const MachineInfluence& i) { return i.name == quantity.name; });
  if (own == std::end(kMachineInfluences) ? quantity.always_modelled : own->acts(machine)) return true;
  for (std::size_t k = 0; k < machine.effects.size(); ++k) {
    const Effect* effect = find_effect(machine.effects[k].name);
    if (activities[k].moved && effect && effect->influence == quantity.name) return true;
  }
  return workpiece && std::any_of(std::begin(kPartInfluences), std::end(kPartInfluences), [&](const PartInfluence& i) {
           return i.name == quantity.name && i.described(*workpiece, run);
         });
}

const InfluenceBound* find_bound(const std::vector<InfluenceBound>& bounds, std::string_view name) {
  const auto found =
      std::find_if(bounds.begin(), bounds.end(), [&](const InfluenceBound& b) { return b.influence == name; });
  return found == bounds.end() ? nullptr : &*found;
}

/// The workpiece file knows the task, so its bound goes before that of the machine file.
const InfluenceBound* bound_on(std::string_view name, const Machine& machine, const Workpiece* workpiece) {
  const InfluenceBound* of_task = workpiece ? find_bound(workpiece->bounds, name) : nullptr;
  return of_task ? of_task : find_bound(machine.bounds, name);
}

}  // namespace

std::string_view name(InfluenceStatus status) {
  constexpr std::string_view names[] = {"not modelled", "modelled", "bounded"};
  return names[static_cast<int>(status)];
}

Declaration declare_influences(const Machine& machine, const EffectActivities& activities, const Workpiece* workpiece,
                               const PartInRun& run) {
  Declaration out;
  for (const InfluenceQuantity& quantity : influence_quantities()) {
    Influence influence{std::string(quantity.name)};
    const InfluenceBound* bound = bound_on(quantity.name, machine, workpiece);
    if (modelled(quantity, machine, activities, workpiece, run)) {
      influence.status = InfluenceStatus::modelled;
      if (bound)
        out.messages.push_back(diagnostic(
            Code::W0434, fmt::format("the bound on \"{}\" is not shown: that influence is modelled", quantity.name),
            "remove the bound, or what models the influence: an effect of the machine file, or the workpiece file"));
    } else if (bound) {
      influence = {influence.name, InfluenceStatus::bounded, kUmPerMm * bound->at_most_mm, bound->source};
    }
    out.influences.push_back(std::move(influence));
  }
  return out;
}

}  // namespace abbe
