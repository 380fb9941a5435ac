#include "engine/report/influences.hpp"

#include <algorithm>
#include <string_view>

namespace abbe {

namespace {

struct Row {
  std::string_view name;
  bool always;  ///< part of every simulation
  std::vector<std::string_view> effects =
      {};  ///< registry names, or families that end in '.', that describe it
  bool (*described_by)(const Workpiece&) = nullptr;
};

const std::vector<Row>& rows() {
  static const std::vector<Row> table = {
      {"geometry", true},
      {"head indexing", true},
      {"probe repeatability", true},
      {"number and place of the points", true},
      {"part temperature",
       false,
       {"thermal.part_expansion", "thermal.part_soak"},
       [](const Workpiece& w) { return w.knows.part && w.part_expands(); }},
      {"scale temperature",
       false,
       {"thermal.scale_expansion"},
       [](const Workpiece& w) { return w.knows.scale[0] && w.scales_expand(); }},
      {"temperature gradients in the machine",
       false,
       {"thermal.table_bending", "thermal.bridge_bending"}},
      {"thermal drift",
       false,
       {"thermal.drift", "thermal.cycle", "thermal.ram_growth", "thermal.stylus_growth"}},
      {"probe pretravel lobing", false, {"probe.pretravel_lobing"}},
      {"stylus bending and length", false, {"probe.stylus_bending", "probe.stylus_length"}},
      {"tip size and form", false, {"probe.tip_radius", "probe.tip_form"}},
      {"contact deformation", false, {"probe.contact_flattening"}},
      {"trigger delay", false, {"probe.trigger_delay"}},
      {"head geometry and qualification",
       false,
       {"head.axis_errors", "head.qualification", "head.sag"}},
      {"dynamics and backlash", false, {"machine.dynamics", "machine.backlash"}},
      {"scale interpolation", false, {"machine.scale_interpolation"}},
      {"vibration and outliers", false, {"noise."}},
      {"true size of the part", false, {}, [](const Workpiece& w) { return !w.surfaces.empty(); }},
      {"form error of the part",
       false,
       {"part.form"},
       [](const Workpiece& w) { return w.has_form(); }},
      {"fixturing", false, {"part.clamping", "part.load_bending", "part.shift"}},
      {"surface roughness and dirt", false},
      {"operator", false},
      {"software", false},
  };
  return table;
}

bool describes(std::string_view pattern, std::string_view effect) {
  return pattern.ends_with('.') ? effect.starts_with(pattern) : effect == pattern;
}

bool modelled(const Row& row, const Machine& machine, const Workpiece* workpiece) {
  return row.always || (workpiece && row.described_by && row.described_by(*workpiece)) ||
         std::any_of(
             machine.effects.begin(), machine.effects.end(), [&](const EffectSetting& effect) {
               return std::any_of(
                   row.effects.begin(), row.effects.end(),
                   [&](std::string_view pattern) { return describes(pattern, effect.name); });
             });
}

}  // namespace

std::vector<Influence> influences(const Machine& machine, const Workpiece* workpiece) {
  std::vector<Influence> list;
  for (const Row& row : rows())
    list.push_back(
        {std::string(row.name), modelled(row, machine, workpiece) ? "modelled" : "not modelled"});
  return list;
}

}  // namespace abbe
