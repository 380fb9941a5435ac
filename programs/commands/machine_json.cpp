// The JSON reports of `abbe machine show` and `abbe machine screen`. Every number is in the unit
// that its key names.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "engine/machine/error_state.hpp"
#include "engine/math/units.hpp"
#include "programs/commands/machine_report.hpp"

namespace abbe {

namespace {

using Json = nlohmann::ordered_json;

/// What the file says, in its unit again: to 15 digits, or 9 um would come back as 9.000000000000002.
double as_given(double value) { return std::strtod(fmt::format("{:.15g}", value).c_str(), nullptr); }

Json triple_json(const Vec3& v) { return {as_given(v.x), as_given(v.y), as_given(v.z)}; }

Json chain(const std::vector<Axis>& axes) {
  Json out = Json::array();
  for (const Axis axis : axes) out.push_back(kAxisNames[static_cast<int>(axis)]);
  return out;
}

Json messages(const std::vector<Diagnostic>& list) {
  Json out = Json::array();
  for (const Diagnostic& d : list)
    out.push_back({{"code", info(d.code).name}, {"message", d.message}, {"help", d.help}});
  return out;
}

Json specification(const Specification& spec) {
  Json out{{"standard", spec.standard}, {"mpe", length_mpe_json(spec.mpe)}};
  if (spec.e150_mpe) out["e150_mpe"] = length_mpe_json(*spec.e150_mpe);
  if (spec.r0_mpl_mm) out["r0_mpl_um"] = as_given(*spec.r0_mpl_mm * kUmPerMm);
  if (spec.form_mpe_mm) out["probing"]["p_form_mpe_um"] = as_given(*spec.form_mpe_mm * kUmPerMm);
  if (spec.size_mpe_mm) out["probing"]["p_size_mpe_um"] = as_given(*spec.size_mpe_mm * kUmPerMm);
  out["v_min"] = spec.v_min;
  out["v_max"] = std::isfinite(spec.v_max) ? Json(spec.v_max) : Json("unlimited");
  out["longest_share"] = spec.longest_share;
  return out;
}

/// The parameters of one error function, and the function of the drawn machine, sampled.
Json component_json(const MachineReport& report, Component component) {
  constexpr int kSamples = 101;
  const Machine& machine = report.machine;
  const ComponentSpec& spec = machine[component];
  const MachineAxis& axis = machine[axis_of(component)];
  const bool rotation = is_rotation(component);
  const char* const unit = rotation ? "um_per_m" : "um";
  Json readings = Json::array(), values = Json::array();
  for (int i = 0; i < kSamples; ++i) {
    const double reading_mm = axis.direction * axis.travel_mm * i / (kSamples - 1);
    readings.push_back(reading_mm);
    values.push_back(error_at(machine, report.drawn.geometry[0], component, reading_mm) * (rotation ? 1e6 : 1e3));
  }
  Json out{{"s", spec.linear}, {"c", spec.curvature}};
  out[rotation ? "e_max_um_per_m2" : "e_max_um_per_m"] = as_given(spec.e_max * (rotation ? 1e6 : 1e3));
  if (!spec.harmonics.empty()) out["harmonics"] = spec.harmonics;
  out["curve"] = {{"reading_mm", readings}, {std::string("error_") + unit, values}};
  return out;
}

Json axes_json(const Machine& machine) {
  Json out = Json::object();
  for (int k = 0; k < 3; ++k) {
    const MachineAxis& axis = machine.axes[k];
    out[kAxisNames[k]] = {{"travel_mm", axis.travel_mm},
                          {"direction", axis.direction},
                          {"side", axis.table_side ? "table" : "ram"},
                          {"offset_mm", triple_json(axis.offset_mm)}};
  }
  return out;
}

Json sensors_json(const Machine& machine) {
  Json out = Json::object();
  for (const auto& [label, s] : machine.sensors)
    out[label] = {{"head_deg", {as_given(in_degrees(s.head_a_rad)), as_given(in_degrees(s.head_b_rad))}},
                  {"tip_in_r_mm", triple_json(s.tip_in_r_mm)},
                  {"diameter_mm", 2 * s.radius_mm},
                  {"shaft_diameter_mm", s.shaft_diameter_mm},
                  {"material", s.material},
                  {"young_GPa", s.young_GPa},
                  {"cte_ppm_per_K", s.cte_ppm_per_K}};
  return out;
}

Json effects_json(const Machine& machine) {
  Json out = Json::array();
  for (const EffectSetting& effect : machine.effects) {
    Json parameters = Json::object();
    for (const auto& [key, value] : effect.parameters)
      parameters[key] = value.word.empty() ? Json{{"value", value.value}, {"u", value.u}} : Json(value.word);
    out.push_back({{"name", effect.name}, {"parameters", parameters}});
  }
  return out;
}

Json bounds_json(const Machine& machine) {
  Json out = Json::array();
  for (const InfluenceBound& b : machine.bounds)
    out.push_back(
        {{"influence", b.influence}, {"at_most_um", as_given(b.at_most_mm * kUmPerMm)}, {"source", b.source}});
  return out;
}

std::string dump(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

Json test_line_json(const TestLine& line) {
  Json mpe_um = Json::array();
  for (const double mpe_mm : line.mpe_mm) mpe_um.push_back(mpe_mm * kUmPerMm);
  return {{"name", line.name},
          {"test", line.test},
          {"start_reading_mm", triple_json(line.start_mm)},
          {"direction", triple_json(line.direction)},
          {"tip_mm", triple_json(line.tip_mm)},
          {"length_mm", line.length_mm},
          {"mpe_um", mpe_um}};
}

Json line_json(const LineReport& report) {
  Json out = test_line_json(report.line);
  out["error_over_mpe"] = {{"median", report.median}, {"p95", report.p95}, {"largest", report.largest}};
  return out;
}

/// The test of the drawn machine, line by line.
Json tested_lines_json(const MachineReport& report) {
  Json out = Json::array();
  for (std::size_t k = 0; k < report.lines.size(); ++k) {
    Json line = test_line_json(report.lines[k]);
    for (const double error_mm : report.tested.error_mm[k]) line["error_um"].push_back(error_mm * kUmPerMm);
    out.push_back(line);
  }
  return out;
}

/// d of the drawn machine over its volume: each component nested by the readings of x, y, z.
Json error_state_json(const MachineReport& report) {
  constexpr int kReadings = 11;
  const ErrorState state = error_state(report.machine, report.drawn.geometry[0], kTestTip, kReadings);
  Json out{{"tip_mm", triple_json(state.tip_mm)}};
  for (int axis = 0; axis < 3; ++axis) out[fmt::format("reading_{}_mm", kAxisNames[axis])] = state.reading_mm[axis];
  for (int axis = 0; axis < 3; ++axis) {
    Json& d_um = out[fmt::format("d_{}_um", kAxisNames[axis])];
    for (int ix = 0; ix < kReadings; ++ix)
      for (int iy = 0; iy < kReadings; ++iy)
        for (int iz = 0; iz < kReadings; ++iz) d_um[ix][iy].push_back(kUmPerMm * state.at(ix, iy, iz)[axis]);
  }
  return out;
}

Json suggestion_json(const std::optional<SuggestedFactor>& suggested) {
  if (!suggested) return nullptr;
  return {
      {"factor", suggested->factor}, {"share_accepted", suggested->share_accepted}, {"largest", suggested->largest}};
}

}  // namespace

Json length_mpe_json(const LengthMpe& mpe) {
  Json out{{"a_um", as_given(mpe.a_mm * kUmPerMm)}, {"k_um_per_m", as_given(mpe.k / kPpm)}};
  if (std::isfinite(mpe.b_mm)) out["b_um"] = as_given(mpe.b_mm * kUmPerMm);
  return out;
}

std::string machine_report_json(const MachineReport& report) {
  const Machine& m = report.machine;
  Json components = Json::object();
  for (int k = 0; k < kComponents; ++k) {
    const auto component = static_cast<Component>(k);
    components[std::string(name(component))] = component_json(report, component);
  }
  return dump(
      {{"schema", "abbe.machine_report/1"},
       {"name", m.name},
       {"axes", axes_json(m)},
       {"chain", {{"ram_side", chain(m.ram_chain)}, {"table_side", chain(m.table_chain)}}},
       {"mount_offset_mm", triple_json(m.mount_offset_mm)},
       {"harmonics", m.harmonics},
       {"squareness_um_per_m",
        {{"cwy", as_given(m.squareness_cwy_rad * 1e6)},
         {"bwz", as_given(m.squareness_bwz_rad * 1e6)},
         {"awz", as_given(m.squareness_awz_rad * 1e6)}}},
       {"specification", specification(m.specification)},
       {"head",
        {{"model", m.head.model},
         {"l_r_mm", m.head.l_r_mm},
         {"angle_sd_arcsec", {{"A", as_given(m.head.sd_a_rad / kArcsec)}, {"B", as_given(m.head.sd_b_rad / kArcsec)}}},
         {"mounting", {{"turn_deg", as_given(in_degrees(m.head.mounting_rad))}}}}},
       {"probe", {{"sd_um", triple_json(kUmPerMm * m.probe.sd_mm)}}},
       {"motion",
        {{"speed_mm_s", m.motion.speed_mm_s},
         {"probing_speed_mm_s", m.motion.probing_speed_mm_s},
         {"acceleration_mm_s2", m.motion.acceleration_mm_s2}}},
       {"sensors", sensors_json(m)},
       {"effects", effects_json(m)},
       {"bounds", bounds_json(m)},
       {"virtual_machine", {{"seed", report.seed}, {"candidate", report.drawn.index[0]}, {"v", report.drawn.v[0]}}},
       {"components", components},
       {"error_state", error_state_json(report)},
       {"lines", tested_lines_json(report)},
       {"messages", messages(report.messages)}});
}

std::string screening_json(const ScreeningReport& report) {
  const ScreeningCounts& c = report.counts;
  Json lines = Json::array();
  for (const LineReport& line : report.lines) lines.push_back(line_json(line));
  Json probe = Json::array();
  for (const ProbeCheck& check : report.probe)
    probe.push_back({{"name", check.name},
                     {"limit_um", as_given(check.limit_mm * kUmPerMm)},
                     {"median_um", check.median_mm * kUmPerMm},
                     {"share_passed", check.share_passed}});
  return dump({{"schema", "abbe.screening/1"},
               {"machine", report.machine.name},
               {"seed", report.seed},
               {"specification", specification(report.machine.specification)},
               {"machines",
                {{"used", c.used},
                 {"generated", c.generated},
                 {"failed_mpe", c.failed_mpe},
                 {"too_small", c.too_small},
                 {"share_accepted", c.share_accepted()}}},
               {"suggested_e_max_factor", suggestion_json(report.suggested)},
               {"lines", lines},
               {"probe", probe},
               {"messages", messages(report.messages)}});
}

}  // namespace abbe
