// The machine file (docs/machine.md): keys, units, defaults and what contradicts what. Conversion
// to mm and rad happens here.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "engine/base/json_reader.hpp"
#include "engine/base/limits.hpp"
#include "engine/machine/geometry.hpp"
#include "engine/machine/machine.hpp"
#include "engine/math/units.hpp"

namespace abbe {

namespace {

constexpr int kMostHarmonics = 64;

constexpr std::string_view kAxisNames[3] = {"x", "y", "z"};

Vec3 vec3(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

int read_direction(JsonObject& axis) {
  const double direction = axis.number_or("direction", 1);
  if (std::abs(direction) != 1)
    axis.fault("direction", Code::E0406, fmt::format("\"direction\" is {:g}, but must be 1 or -1", direction),
               "1 when the readings grow from 0 to the travel, -1 when they fall from 0 to minus "
               "the travel");
  return direction < 0 ? -1 : 1;
}

void read_axes(JsonObject axes, Machine& machine) {
  for (int k = 0; k < 3; ++k) {
    JsonObject axis = axes.object(kAxisNames[k]);
    machine.axes[k].travel_mm = axis.number("travel_mm", kLength_mm);
    machine.axes[k].direction = read_direction(axis);
  }
}

std::vector<Axis> read_side(JsonObject& chain, std::string_view key, std::vector<std::string> otherwise,
                            int (&times)[3]) {
  std::vector<Axis> side;
  for (const std::string& name : chain.text_list_or(key, std::move(otherwise))) {
    const auto found = std::find(std::begin(kAxisNames), std::end(kAxisNames), name);
    if (found == std::end(kAxisNames)) {
      chain.fault(key, Code::E0412, fmt::format("\"{}\" is not an axis", name), "the axes are \"x\", \"y\" and \"z\"");
      continue;
    }
    const auto axis = static_cast<int>(found - std::begin(kAxisNames));
    ++times[axis];
    side.push_back(static_cast<Axis>(axis));
  }
  return side;
}

void read_chain(JsonObject chain, Machine& machine) {
  int times[3] = {};
  machine.ram_chain = read_side(chain, "ram_side", {"x", "y", "z"}, times);
  machine.table_chain = read_side(chain, "table_side", {}, times);
  for (const Axis axis : machine.table_chain) machine.axes[static_cast<int>(axis)].table_side = true;
  for (int k = 0; k < 3; ++k) {
    if (times[k] == 1) continue;
    chain.fault(
        times[k] ? "table_side" : "ram_side", Code::E0412,
        fmt::format("axis \"{}\" {} in the chain", kAxisNames[k], times[k] ? "stands more than once" : "is missing"),
        "each axis stands once, in \"ram_side\" when it carries the probe, in "
        "\"table_side\" when it carries the part, "
        "in the order from the base outwards");
  }
}

void read_offsets(JsonObject offsets, Machine& machine) {
  const auto offset = [&](std::string_view key) {
    if (!offsets.present() || !offsets.has(key)) machine.offsets_not_given.emplace_back(key);
    return vec3(offsets.numbers_or(key, {0, 0, 0}, 3, kCoordinate_mm));
  };
  for (int k = 0; k < 3; ++k) machine.axes[k].offset_mm = offset(kAxisNames[k]);
  machine.mount_offset_mm = offset("mount");
}

/// Table 1 of the paper.
ComponentSpec default_component(Component c) {
  if (is_rotation(c)) return {0.6, 0, 10 * kPpm, {}};
  const bool positioning = static_cast<int>(c) % 6 == static_cast<int>(axis_of(c));
  return positioning ? ComponentSpec{0.8, 0.1, 7 * kUm, {}} : ComponentSpec{0.5, 0.4, 7 * kUm, {}};
}

void check_shares(JsonObject& object, const ComponentSpec& spec, int harmonics) {
  const double trend = spec.linear + spec.curvature;
  if (trend > 1 + 1e-9) {
    object.fault("s", Code::E0413, fmt::format("s + c is {:.6g}, but the shares of one error function sum to 1", trend),
                 "s + c may be at most 1; what is left goes to the harmonics");
  } else if (!spec.harmonics.empty()) {
    const double sum = std::accumulate(spec.harmonics.begin(), spec.harmonics.end(), trend);
    if (std::abs(sum - 1) > 1e-6)
      object.fault("harmonics", Code::E0413, fmt::format("s + c + the harmonics is {:.6g}, but must be 1", sum),
                   "scale the amplitudes, or leave \"harmonics\" out to have them drawn at random");
    if (static_cast<int>(spec.harmonics.size()) > harmonics)
      object.fault("harmonics", Code::E0413,
                   fmt::format("{} amplitudes, but the file has {} harmonics", spec.harmonics.size(), harmonics),
                   "raise \"geometry.harmonics\"");
  } else if (harmonics == 0 && trend == 0) {
    object.fault("s", Code::E0413, "this error function is empty: no harmonics, and s and c are 0",
                 "give s or c, or set e_max to 0 and s to 1");
  }
}

void read_geometry(JsonObject geometry, Machine& machine) {
  machine.harmonics = geometry.integer_or("harmonics", 7, 0, kMostHarmonics);
  JsonObject components = geometry.object_or_absent("components");
  for (int k = 0; k < kComponents; ++k) {
    const auto component = static_cast<Component>(k);
    ComponentSpec spec = default_component(component);
    JsonObject object = components.object_or_absent(name(component));
    const double unit = is_rotation(component) ? kPpm : kUm;
    spec.linear = object.number_or("s", spec.linear, kShare);
    spec.curvature = object.number_or("c", spec.curvature, kShare);
    spec.e_max = object.number_or("e_max", spec.e_max / unit, kNotNegative) * unit;
    spec.harmonics = object.number_list("harmonics", kShare);
    if (object.present()) check_shares(object, spec, machine.harmonics);
    machine[component] = std::move(spec);
  }
  JsonObject squareness = geometry.object_or_absent("squareness_um_per_m");
  machine.squareness_cwy_rad = squareness.number_or("cwy", 0) * kPpm;
  machine.squareness_bwz_rad = squareness.number_or("bwz", 0) * kPpm;
  machine.squareness_awz_rad = squareness.number_or("awz", 0) * kPpm;
}

LengthMpe read_length_mpe(JsonObject mpe) {
  LengthMpe out;
  out.a_mm = mpe.number("a_um", kNotNegative) * kUm;
  out.k = mpe.number("k_um_per_m", kNotNegative) * kPpm;
  out.b_mm = mpe.number_or("b_um", kInfinity, kPositive) * kUm;
  if (mpe.has("a_um") && mpe.has("k_um_per_m") && out.a_mm == 0 && out.k == 0)
    mpe.fault("a_um", Code::E0414, "a and k are both 0: no machine has a maximum permissible error of 0",
              "MPE(l) = a + k l, as the data sheet gives it: 5 + 5 um/m is \"a_um\": 5, "
              "\"k_um_per_m\": 5");
  if (out.b_mm < out.a_mm)
    mpe.fault("b_um", Code::E0414,
              fmt::format("b is {:g} um, less than a: MPE(l) = min(a + k l, b) would be b at every "
                          "length",
                          out.b_mm / kUm),
              "for an MPE that does not grow with the length, set a to it, k to 0 and leave b out");
  return out;
}

std::optional<double> read_limit_um(JsonObject& object, std::string_view key) {
  const double limit_um = object.number_or(key, 0, kPositive);  // 0: not given
  return limit_um > 0 ? std::optional(limit_um * kUm) : std::nullopt;
}

/// E150 and R0 came with the edition of 2009.
void read_2009(JsonObject& object, Specification& spec) {
  constexpr std::string_view kEdition = "ISO 10360-2:2009";
  for (const std::string_view key : {"e150_mpe", "r0_mpl_um"})
    if (object.has(key) && spec.standard != kEdition)
      object.fault(key, Code::E0414,
                   fmt::format("\"{}\" belongs to {}, but the standard is \"{}\"", key, kEdition, spec.standard),
                   fmt::format("set \"standard\" to \"{}\", or remove \"{}\"", kEdition, key));
  if (object.has("e150_mpe")) spec.e150_mpe = read_length_mpe(object.object("e150_mpe"));
  spec.r0_mpl_mm = read_limit_um(object, "r0_mpl_um");
}

/// "unlimited" lets machines pass that are better than their specification by any factor, even an
/// error-free one.
double read_v_max(JsonObject& object) {
  if (object.kind_of("v_max") != JsonNode::Kind::text) return object.number_or("v_max", 2, kPositive);
  object.one_of("v_max", object.text("v_max"), {"unlimited"});
  return kInfinity;
}

void read_specification(JsonObject object, Specification& spec) {
  spec.standard = object.text_or("standard", "ISO 10360-2");
  spec.mpe = read_length_mpe(object.object("mpe"));
  read_2009(object, spec);
  JsonObject probing = object.object_or_absent("probing");
  spec.form_mpe_mm = read_limit_um(probing, "p_form_mpe_um");
  spec.size_mpe_mm = read_limit_um(probing, "p_size_mpe_um");
  spec.v_min = object.number_or("v_min", 1, kPositive);
  spec.v_max = read_v_max(object);
  if (spec.v_min >= spec.v_max)
    object.fault(object.has("v_min") ? "v_min" : "v_max", Code::E0414,
                 fmt::format("v_min is {:g} and v_max {:g}: no machine lies between", spec.v_min, spec.v_max),
                 "v = min |MPE / error|; the usual range is 1 to 2");
  spec.longest_share = object.number_or("longest_share", Specification::kLeastLongestShare, kPositiveShare);
}

void read_head(JsonObject object, HeadSpec& head) {
  if (!object.present()) return;
  head.present = true;
  head.model = object.text_or("model", "");
  head.l_r_mm = object.number_or("l_r_mm", 0, kDistance_mm);
  JsonObject sd = object.object("angle_sd_arcsec");
  head.sd_a_rad = sd.number("A", kIndexingSd_arcsec) * kArcsec;
  head.sd_b_rad = sd.number("B", kIndexingSd_arcsec) * kArcsec;
  head.mounting_rad = object.object_or_absent("mounting").number_or("turn_deg", 0, kTurn_deg) * kDegree;
}

struct Material {
  std::string_view name;
  double young_GPa, cte_ppm_per_K;
};
// Typical values of stylus shafts; a file that knows better gives its own numbers.
constexpr Material kMaterials[] = {{"tungsten carbide", NamedSensor::kUsualYoung_GPa, NamedSensor::kUsualCte_ppm_per_K},
                                   {"steel", 200, 11.5},
                                   {"ceramic", 350, 7.5},
                                   {"carbon fibre", 450, -0.4}};

NamedSensor read_sensor(JsonObject object) {
  NamedSensor sensor;
  const std::vector<double> head = object.numbers_or("head_deg", {0, 0}, 2, kTurn_deg);
  sensor.head_a_rad = head[0] * kDegree;
  sensor.head_b_rad = head[1] * kDegree;
  if (!object.has("tip_in_r_mm"))
    object.fault("tip_in_r_mm", Code::E0404, "a sensor needs \"tip_in_r_mm\", the centre of its tip seen from the head",
                 "a straight stylus of 100 mm is \"tip_in_r_mm\": [0, 0, -100]");
  sensor.tip_in_r_mm = vec3(object.numbers_or("tip_in_r_mm", {0, 0, 0}, 3, kCoordinate_mm));
  const double diameter_mm = object.number("diameter_mm", kLength_mm);
  sensor.radius_mm = diameter_mm / 2;
  sensor.shaft_diameter_mm = object.number_or("shaft_diameter_mm", diameter_mm / 2, kPositive);
  if (diameter_mm > 0 && sensor.shaft_diameter_mm > diameter_mm)
    object.fault(
        "shaft_diameter_mm", Code::E0406,
        fmt::format("the shaft is {:g} mm thick, but the ball only {:g} mm", sensor.shaft_diameter_mm, diameter_mm),
        "such a stylus touches with its shaft: give the diameter of the shaft next to the ball");
  sensor.material = object.text_or("material", "tungsten carbide");
  std::vector<std::string_view> names;
  Material material = kMaterials[0];
  for (const Material& m : kMaterials) {
    names.push_back(m.name);
    if (m.name == sensor.material) material = m;
  }
  if (object.has("material") && !(object.has("young_GPa") && object.has("cte_ppm_per_K")))
    object.one_of("material", sensor.material, names);
  sensor.young_GPa = object.number_or("young_GPa", material.young_GPa, kYoung_GPa);
  sensor.cte_ppm_per_K = object.number_or("cte_ppm_per_K", material.cte_ppm_per_K, kCte_ppm_per_K);
  return sensor;
}

void read_sensors(JsonObject sensors, Machine& machine) {
  for (const std::string& name : sensors.own_names()) {
    const auto [first, is_first] = machine.sensors.try_emplace(name, read_sensor(sensors.object(name)));
    if (!is_first)
      sensors.fault(name, Code::E0403,
                    fmt::format("there are two sensors \"{}\": case does not matter, and one is called \"{}\"", name,
                                first->first),
                    "programs could not tell them apart: rename one of the two");
  }
}

EffectSetting read_effect(JsonObject object, const std::shared_ptr<const SourceFile>& file) {
  EffectSetting effect;
  effect.file = file;
  effect.name = object.text("name");
  effect.span = object.span_of("name");
  JsonObject parameters = object.object_or_absent("parameters");
  for (const std::string& key : parameters.own_names()) {
    EffectSetting::Value& parameter = effect.parameters[key];
    parameter.span = parameters.span_of(key);
    if (parameters.kind_of(key) == JsonNode::Kind::object) {
      JsonObject value = parameters.object(key);
      parameter.value = value.number("value");
      parameter.u = value.number_or("u", 0, kNotNegative);
    } else if (parameters.kind_of(key) == JsonNode::Kind::text) {
      parameter.word = parameters.text(key);
    } else {
      parameter.value = parameters.number(key);
    }
  }
  return effect;
}

/// A list of the known state holds a number for every coefficient of the error functions.
void check_coefficients(JsonObject& state, std::string_view key, std::size_t given, int harmonics) {
  const std::size_t asked = static_cast<std::size_t>(kComponents) * basis_size(harmonics);
  if (given != asked)
    state.fault(key, Code::E0706,
                fmt::format("the known_state has {} numbers in \"{}\", but the error functions of this file have {} "
                            "coefficients",
                            given, key, asked),
                "it was made with another \"geometry.harmonics\": make it anew with "
                "`abbe diagnose CALIBRATION.csv --machine M --model-out KNOWN.json`");
}

/// As `abbe diagnose --model-out` writes it (engine/diagnose/baseline/known_state.cpp).
std::optional<KnownState> read_known_state(JsonObject state, int harmonics) {
  constexpr NumberRange kCoefficient{-1e6, 1e6, true, true, "between -1e6 and 1e6"};
  if (!state.present()) return std::nullopt;
  state.check_schema(KnownState::kSchema, "a known state",
                     "make it anew with `abbe diagnose CALIBRATION.csv --machine M --model-out KNOWN.json`");
  state.number_or("geometry_scale", 1, kNotNegative);  // for people; mean and factor hold it already
  KnownState known{state.number_list("mean", kCoefficient), state.number_lists("factor", kCoefficient)};
  for (const std::string_view key : {"mean", "factor"})
    if (!state.has(key))
      state.fault(key, Code::E0404, fmt::format("the known_state lacks \"{}\"", key),
                  "copy the whole \"known_state\" that `abbe diagnose --model-out` wrote");
  if (state.kind_of("mean") == JsonNode::Kind::array) check_coefficients(state, "mean", known.mean.size(), harmonics);
  for (const std::vector<double>& column : known.factor) check_coefficients(state, "factor", column.size(), harmonics);
  return known;
}

}  // namespace

Machine parse_machine(const std::string& file, const std::string& text) {
  JsonReader reader(SourceFile(file, text));
  JsonObject root = reader.root();
  root.offer("schema");
  if (root.has("schema"))
    root.check_schema("abbe.machine/1", "a machine file",
                      "is this the right file? `abbe machine init NAME` prints a complete machine file");
  Machine machine;
  machine.name = root.text("name");
  read_axes(root.object("axes"), machine);
  read_chain(root.object_or_absent("chain"), machine);
  read_offsets(root.object_or_absent("offsets_mm"), machine);
  read_geometry(root.object_or_absent("geometry"), machine);
  read_specification(root.object("specification"), machine.specification);
  read_head(root.object_or_absent("head"), machine.head);
  machine.probe.sd_mm = vec3(root.object_or_absent("probe").numbers_or("sd_um", {0.5, 0.5, 0.5}, 3, kProbeSd_um)) * kUm;
  JsonObject motion = root.object_or_absent("motion");
  machine.motion.speed_mm_s = motion.number_or("speed_mm_s", 200, kPositive);
  machine.motion.probing_speed_mm_s = motion.number_or("probing_speed_mm_s", 5, kPositive);
  machine.motion.acceleration_mm_s2 = motion.number_or("acceleration_mm_s2", 500, kPositive);
  read_sensors(root.object_or_absent("sensors"), machine);
  const auto source = std::make_shared<const SourceFile>(file, text);
  for (const JsonObject& effect : root.object_list("effects")) machine.effects.push_back(read_effect(effect, source));
  machine.bounds = read_bounds(root);
  machine.known_state = read_known_state(root.object_or_absent("known_state"), machine.harmonics);
  reader.finish();
  return machine;
}

}  // namespace abbe
