#include "engine/report/influences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "engine/math/units.hpp"

namespace abbe {

namespace {

/// What makes an influence modelled that is not part of every simulation.
struct Row {
  std::string_view name;
  /// Registry names, or families that end in '.', that describe it.
  std::vector<std::string_view> effects = {};
  bool (*described_by)(const Workpiece&) = nullptr;
};

/// Influences that are not listed here cannot be modelled.
const std::vector<Row>& rows() {
  static const std::vector<Row> table = {
      {"part temperature",
       {"thermal.part_expansion", "thermal.part_soak"},
       [](const Workpiece& w) { return w.knows.part && w.part_expands(); }},
      {"scale temperature",
       {"thermal.scale_expansion"},
       [](const Workpiece& w) { return w.knows.scale[0] && w.scales_expand(); }},
      {"temperature gradients in the machine", {"thermal.table_bending", "thermal.bridge_bending"}},
      {"thermal drift", {"thermal.drift", "thermal.cycle", "thermal.ram_growth", "thermal.stylus_growth"}},
      {"probe pretravel lobing", {"probe.pretravel_lobing"}},
      {"stylus bending and length", {"probe.stylus_bending", "probe.stylus_length"}},
      {"tip size and form", {"probe.tip_radius", "probe.tip_form"}},
      {"contact deformation", {"probe.contact_flattening"}},
      {"trigger delay", {"probe.trigger_delay"}},
      {"head geometry and qualification", {"head.axis_errors", "head.qualification", "head.sag"}},
      {"dynamics and backlash", {"machine.dynamics", "machine.backlash"}},
      {"scale interpolation", {"machine.scale_interpolation"}},
      {"vibration and outliers", {"noise."}},
      {"true size of the part", {}, [](const Workpiece& w) { return !w.surfaces.empty(); }},
      {"form error of the part", {"part.form"}, [](const Workpiece& w) { return w.has_form(); }},
      {"fixturing", {"part.clamping", "part.load_bending", "part.shift"}},
  };
  return table;
}

bool describes(std::string_view pattern, std::string_view effect) {
  return pattern.ends_with('.') ? effect.starts_with(pattern) : effect == pattern;
}

bool described(const Row& row, const Machine& machine, const std::vector<char>& acted, const Workpiece* workpiece) {
  if (workpiece && row.described_by && row.described_by(*workpiece)) return true;
  for (std::size_t k = 0; k < machine.effects.size(); ++k)
    for (const std::string_view pattern : row.effects)
      if (acted[k] && describes(pattern, machine.effects[k].name)) return true;
  return false;
}

bool modelled(const InfluenceQuantity& quantity, const Machine& machine, const std::vector<char>& acted,
              const Workpiece* workpiece) {
  return quantity.always_modelled || std::any_of(rows().begin(), rows().end(), [&](const Row& row) {
           return row.name == quantity.name && described(row, machine, acted, workpiece);
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

Declaration declare_influences(const Machine& machine, const std::vector<char>& acted, const Workpiece* workpiece) {
  Declaration out;
  for (const InfluenceQuantity& quantity : influence_quantities()) {
    Influence influence{std::string(quantity.name), "not modelled"};
    const InfluenceBound* bound = bound_on(quantity.name, machine, workpiece);
    if (modelled(quantity, machine, acted, workpiece)) {
      influence.status = "modelled";
      if (bound)
        out.messages.push_back(diagnostic(
            Code::W0434, fmt::format("the bound on \"{}\" is not shown: that influence is modelled", quantity.name),
            "remove the bound from the file, or the effect that models the influence"));
    } else if (bound) {
      influence = {influence.name, "bounded", kUmPerMm * bound->at_most_mm, bound->source};
    }
    out.influences.push_back(std::move(influence));
  }
  return out;
}

}  // namespace abbe
