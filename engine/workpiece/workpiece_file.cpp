// The workpiece file (docs/workpiece.md): keys, units, defaults and what contradicts what. Conversion
// to mm and 1/K happens here.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "engine/base/file_kind.hpp"
#include "engine/base/letter_case.hpp"
#include "engine/base/limits.hpp"
#include "engine/math/units.hpp"
#include "engine/workpiece/workpiece.hpp"

namespace abbe {

namespace {

constexpr int kMostUndulations = 500;
constexpr NumberRange kTemperature{kColdest_C, kHottest_C, true, true, "between -50 and 150"};
// Of surfaces, um: none lies further than 100 mm from where the drawing has it.
constexpr NumberRange kDeviation{-1e5, 1e5, true, true, "between -100000 and 100000"};
constexpr NumberRange kSpread{0, 1e5, true, true, "between 0 and 100000"};
constexpr NumberRange kExpansion{-30, 100, true, true, "between -30 and 100"};

void twice(JsonObject& object, std::string_view key, std::string_view other) {
  object.fault(key, Code::E0422, fmt::format("\"{}\" and {} say the same thing twice", key, other),
               "remove one of the two");
}

/// A temperature without a coefficient of expansion would silently do nothing.
void need_expansion(JsonObject& root) {
  JsonObject material = root.object_or_absent("material");
  if (!root.has("temperature") || material.has("cte_ppm_per_K") || material.has("cte_minus_scale_ppm_per_K")) return;
  root.fault("temperature", Code::E0404, "temperatures need the coefficient of expansion of the part",
             "add \"material\": {\"cte_ppm_per_K\": 11.5}; 0 for a part that does not expand");
}

void read_material(JsonObject material, JsonObject scales, Workpiece& w) {
  w.scale_cte_per_K = kPpm * read_uncertain(scales, "cte_ppm_per_K", 0, kExpansion);
  w.material = material.text_or("name", "");
  w.part_cte_from_scale = material.has("cte_minus_scale_ppm_per_K");
  const std::string_view key = w.part_cte_from_scale ? "cte_minus_scale_ppm_per_K" : "cte_ppm_per_K";
  w.part_cte_per_K = kPpm * read_uncertain(material, key, 0, w.part_cte_from_scale ? kAnyNumber : kExpansion);
  if (!w.part_cte_from_scale) return;
  if (material.has("cte_ppm_per_K")) {
    read_uncertain(material, "cte_ppm_per_K");
    twice(material, "cte_minus_scale_ppm_per_K", "\"cte_ppm_per_K\"");
  }
  if (!scales.has("cte_ppm_per_K"))
    material.fault(key, Code::E0404, "a coefficient relative to the scales needs that of the scales",
                   "add \"scales\": {\"cte_ppm_per_K\": ...}");
}

void read_scale_temperatures(JsonObject& t, Workpiece& w) {
  const Uncertain common = read_uncertain(t, "scale_C", kReferenceTemperature_C, kTemperature);
  for (int k = 0; k < 3; ++k) {
    const std::string key = fmt::format("scale_{}_C", "xyz"[k]);
    const auto column = static_cast<TemperatureLog::Column>(TemperatureLog::x + k);
    const bool own = t.has(key);
    w.scale_C[k] = own ? read_uncertain(t, key, kReferenceTemperature_C, kTemperature) : common;
    w.scale_name[k] = own ? "temperature." + key : "temperature.scale_C";
    if (own && t.has("scale_C")) twice(t, key, "\"scale_C\"");
    if (w.log.has(column) && (own || t.has("scale_C")))
      twice(t, own ? key : "scale_C", fmt::format("the column {} of the log", w.log.kNames[column]));
  }
}

void read_difference(JsonObject& t, Workpiece& w) {
  if (!t.has("part_minus_scale_K")) return;
  w.part_minus_scale_K = read_uncertain(t, "part_minus_scale_K");
  const bool part = t.has("part_C") || w.log.has(TemperatureLog::part);
  bool single = false;
  for (int k = 0; k < 3; ++k)
    single |= t.has(fmt::format("scale_{}_C", "xyz"[k])) ||
        w.log.has(static_cast<TemperatureLog::Column>(TemperatureLog::x + k));
  w.part_follows_scale = !part;
  if (single || (part && t.has("scale_C"))) twice(t, "part_minus_scale_K", "the temperatures of part and scales");
}

void read_log(JsonObject& t, Workpiece& w) {
  if (!t.has("log")) return;
  const std::filesystem::path file = t.text("log");
  w.log_file = (std::filesystem::path(w.source.name()).parent_path() / file).string();
  w.log = read_temperature_log(read_source(w.log_file));
}

void note_what_is_known(const JsonObject& t, Workpiece& w) {
  const bool difference = w.part_minus_scale_K.has_value();
  w.knows.part = difference || t.has("part_C") || w.log.has(TemperatureLog::part);
  w.knows.air = t.has("air_C") || w.log.has(TemperatureLog::air);
  for (int k = 0; k < 3; ++k)
    w.knows.scale[k] = difference || t.has("scale_C") || t.has(fmt::format("scale_{}_C", "xyz"[k])) ||
        w.log.has(static_cast<TemperatureLog::Column>(TemperatureLog::x + k));
}

void read_temperature(JsonObject t, Workpiece& w) {
  read_log(t, w);
  w.part_C = read_uncertain(t, "part_C", kReferenceTemperature_C, kTemperature);
  if (t.has("part_C") && w.log.has(TemperatureLog::part)) twice(t, "part_C", "the column temp_part_C of the log");
  read_scale_temperatures(t, w);
  read_difference(t, w);
  w.other.air = t.number_or("air_C", kReferenceTemperature_C, kTemperature);
  if (t.has("air_C") && w.log.has(TemperatureLog::air)) twice(t, "air_C", "the column temp_air_C of the log");
  w.other.table_top_minus_bottom_K = t.number_or("table_top_minus_bottom_K", 0);
  w.other.bridge_gradient_K = t.number_or("bridge_gradient_K", 0);
  w.other.legs_difference_K = t.number_or("legs_difference_K", 0);
  note_what_is_known(t, w);
}

void read_compensation(JsonObject c, Workpiece& w) {
  w.compensated = c.flag_or("on", false);
  const double part_cte = w.part_cte_per_K.value + (w.part_cte_from_scale ? w.scale_cte_per_K.value : 0);
  w.assumed_part_cte_per_K = kPpm * c.number_or("cte_ppm_per_K", part_cte / kPpm, kExpansion);
  w.assumed_scale_cte_per_K = kPpm * c.number_or("scale_cte_ppm_per_K", w.scale_cte_per_K.value / kPpm, kExpansion);
  w.sensor_K = read_uncertain(c, "sensor_K");
}

FormHarmonic read_harmonic(JsonObject object) {
  FormHarmonic h;
  if (!object.has("undulations"))
    object.fault("undulations", Code::E0404, "a form error needs \"undulations\", how many waves go once around",
                 "2 for an oval, 3 for three lobes");
  h.undulations = object.integer_or("undulations", 2, 1, kMostUndulations);
  if (!object.has("amplitude_um"))
    object.fault("amplitude_um", Code::E0404, "a form error needs \"amplitude_um\"", "half of its peak to valley");
  h.amplitude_mm = kUm * read_uncertain(object, "amplitude_um", 0, kDeviation);
  if (object.kind_of("phase_deg") == JsonNode::Kind::text) {
    object.one_of("phase_deg", object.text("phase_deg"), {"random"});
  } else {
    h.phase_half_turns = object.number("phase_deg", kTurn_deg) / 180;
  }
  return h;
}

Surface read_surface(JsonObject object, std::string label, Span label_span) {
  Surface s;
  s.label = std::move(label);
  s.label_span = label_span;
  for (const char* key : {"diameter_mm", "diameter_deviation_um", "offset_um"}) object.offer(key);
  s.offset_mm = kUm * read_uncertain(object, "offset_um", 0, kDeviation);
  if (object.has("diameter_mm")) s.diameter_mm = read_uncertain(object, "diameter_mm", 0, kPositive);
  if (object.has("diameter_deviation_um"))
    s.diameter_deviation_mm = kUm * read_uncertain(object, "diameter_deviation_um", 0, kDeviation);
  if (s.diameter_mm && s.diameter_deviation_mm) twice(object, "diameter_deviation_um", "\"diameter_mm\"");
  if (object.has("offset_um") && (s.diameter_mm || s.diameter_deviation_mm))
    twice(object, "offset_um", s.diameter_mm ? "\"diameter_mm\"" : "\"diameter_deviation_um\"");
  for (const JsonObject& harmonic : object.object_list("form")) s.form.push_back(read_harmonic(harmonic));
  s.random_form_mm = kUm * read_uncertain(object, "random_form_um", 0, kSpread);
  return s;
}

void read_surfaces(JsonObject surfaces, Workpiece& w) {
  for (const std::string& label : surfaces.own_names()) {
    for (const Surface& other : w.surfaces)
      if (same_label(other.label, label)) twice(surfaces, label, '"' + other.label + '"');
    w.surfaces.push_back(read_surface(surfaces.object(label), label, surfaces.span_of(label)));
  }
}

/// Whether it is another temperature than the reference, or may be.
bool is_warm(const Uncertain& temperature_C) {
  return temperature_C.value != kReferenceTemperature_C || !temperature_C.exact();
}

}  // namespace

bool Workpiece::has_form(bool recorded) const {
  return std::any_of(surfaces.begin(), surfaces.end(), [&](const Surface& s) {
    return !s.random_form_mm.is_zero() || std::any_of(s.form.begin(), s.form.end(), [&](const FormHarmonic& h) {
      return recorded && h.phase_half_turns ? !h.amplitude_mm.exact() : !h.amplitude_mm.is_zero();
    });
  });
}

bool Workpiece::has_sizes(bool recorded) const {
  const auto more = [&](const Uncertain& q) { return recorded ? !q.exact() : !q.is_zero(); };
  return std::any_of(surfaces.begin(), surfaces.end(), [&](const Surface& s) {
    return more(s.offset_mm) || (s.diameter_mm && more(*s.diameter_mm)) ||
        (s.diameter_deviation_mm && more(*s.diameter_deviation_mm));
  });
}

bool Workpiece::part_expands() const {
  return !part_cte_per_K.is_zero() || (part_cte_from_scale && !scale_cte_per_K.is_zero());
}

bool Workpiece::scales_expand() const { return !scale_cte_per_K.is_zero(); }

bool Workpiece::part_temperature_acts(bool compensates) const {
  const bool warm = log.has(TemperatureLog::part) || is_warm(part_C) ||
      (part_follows_scale && (!part_minus_scale_K->is_zero() || is_warm(scale_C[0])));
  const bool assumed = compensates && assumed_part_cte_per_K != 0;
  return (warm && (part_expands() || assumed)) || (assumed && !sensor_K.is_zero());
}

bool Workpiece::scale_temperature_acts(bool compensates) const {
  const bool follow = part_minus_scale_K && !part_follows_scale;
  const bool warm = log.has(TemperatureLog::x) || log.has(TemperatureLog::y) || log.has(TemperatureLog::z) ||
      std::any_of(scale_C, scale_C + 3, is_warm) ||
      (follow && (!part_minus_scale_K->is_zero() || log.has(TemperatureLog::part) || is_warm(part_C)));
  const bool assumed = compensates && assumed_scale_cte_per_K != 0;
  return (warm && (scales_expand() || assumed)) || (assumed && !sensor_K.is_zero());
}

Workpiece parse_workpiece(const SourceFile& file) {
  JsonReader reader(file);
  JsonObject root = reader.root();
  root.check_schema("abbe.workpiece/1", "a workpiece file",
                    "is this the right file? docs/workpiece.md describes workpiece files");
  Workpiece w;
  w.source = file;
  w.name = root.text("name");
  read_temperature(root.object_or_absent("temperature"), w);
  read_material(root.object_or_absent("material"), root.object_or_absent("scales"), w);
  need_expansion(root);
  read_compensation(root.object_or_absent("compensation"), w);
  w.knows.load = root.has("load_kg");
  w.load_kg = root.number_or("load_kg", 0, kNotNegative);
  read_surfaces(root.object_or_absent("surfaces"), w);
  w.bounds = read_bounds(root);
  reader.finish();
  return w;
}

Workpiece read_workpiece(const std::string& path) {
  const SourceFile source = read_source(path);
  refuse_other_kind(source, FileKind::json);
  return parse_workpiece(source);
}

}  // namespace abbe
