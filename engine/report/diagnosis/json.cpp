#include <functional>
#include <set>

#include "engine/math/units.hpp"
#include "engine/report/diagnosis/diagnosis_report.hpp"
#include "engine/report/json_value.hpp"

namespace abbe {

namespace {

template <class List, class F>
Json array(const List& list, F item) {
  Json out = Json::array();
  for (const auto& x : list) out.push_back(item(x));
  return out;
}

Json parameters(const std::vector<DiagnosedParameter>& list) {
  Json out = Json::object();
  for (const DiagnosedParameter& p : list) {
    Json& told = out[p.name];
    if (!p.word.empty())
      told = {{"value", p.word}};
    else
      told = {{"value", number(p.value)},
              {"u", number(p.u)},
              {"interval95", {number(p.low), number(p.high)}},
              {"plausible", p.plausible}};
    if (!p.others.empty()) {
      told["probability"] = number(p.probability);
      told["others"] = array(p.others, [](const OtherValue& v) {
        return Json{{"value", v.value}, {"probability", number(v.probability)}};
      });
    }
  }
  return out;
}

Json effect(const DiagnosedEffect& e) {
  const auto in_run = [&](int RunChange::*end) {
    Json list = Json::array();
    for (std::size_t m = 0; m < e.members.size(); ++m)
      list.push_back(m < e.change.size() && e.change[m].*end > 0 ? Json(e.change[m].*end) : Json());
    return list;
  };
  Json by_member = Json::array();
  for (const DiagnosedMember& m : e.by_member)
    by_member.push_back({{"probability", number(m.probability)}, {"parameters", parameters(m.parameters)}});
  return {{"members", e.members},
          {"probability", number(e.probability)},
          {"by_member", by_member},
          {"parameters", parameters(e.parameters)},
          {"sentence", e.sentence},
          {"new_in_run", in_run(&RunChange::from)},
          {"gone_in_run", in_run(&RunChange::until)},
          {"largest_um", e.largest_um ? number(*e.largest_um) : Json()}};
}

Json location(const Location& l) {
  Json where = Json::object();
  for (const auto& [key, value] : l.where) where[key] = value;
  return {{"factor", l.factor}, {"where", where}, {"share", number(l.share)}, {"p", number(l.p)}};
}

Json unexplained(const std::optional<Unexplained>& u) {
  if (!u) return {};
  return {{"factor", u->factor},
          {"shape", u->shape},
          {"amplitude_um",
           {{"value", number(u->amplitude_um)},
            {"u", number(u->amplitude_u_um)},
            {"interval95", {number(u->low_um), number(u->high_um)}}}},
          {"largest_um", u->largest_um ? number(*u->largest_um) : Json()},
          {"sentence", u->sentence},
          {"model", u->model.empty() ? Json() : Json(u->model)}};
}

Json improvement(const std::optional<Improvement>& i) {
  if (!i) return {};
  const auto change = [](double before, double after) {
    return Json{{"before", number(before)}, {"after", number(after)}};
  };
  return {{"scheme", i->scheme},
          {"log_score_gain", number(i->log_score_gain)},
          {"se", number(i->se)},
          {"rms_um", change(i->rms_before_um, i->rms_after_um)},
          {"bias_um", change(i->bias_before_um, i->bias_after_um)},
          {"chi2_per_dof", change(i->chi2_per_dof_before, i->chi2_per_dof_after)}};
}

/// By parameter: a number, or a word.
Json form(const std::vector<DiagnosedParameter>& parameters) {
  Json out = Json::object();
  for (const DiagnosedParameter& p : parameters) out[p.name] = p.word.empty() ? number(p.value) : Json(p.word);
  return out;
}

Json detectable(const Detectable& d) {
  return {{"effect", d.effect},           {"parameter", d.parameter}, {"unit", d.unit},
          {"detect", number(d.detect)},   {"name", number(d.name)},   {"detect_um", number(d.detect_um)},
          {"name_um", number(d.name_um)}, {"form", form(d.form)},     {"confounded_with", d.confounded_with},
          {"only_new", d.only_new}};
}

Json next(const NextMeasurement& n) {
  return {{"change", n.change},           {"instruction", n.instruction},
          {"separates", n.separates},     {"expected_probability", number(n.expected_probability)},
          {"minutes", number(n.minutes)}, {"program", n.program}};
}

Json baseline(const BaselineSummary& b) {
  Json sensors = Json::object();
  for (const auto& [name, noise] : b.noise_by_sensor) sensors[name] = number(noise);
  return {{"mode", b.known ? "known" : "fresh"},
          {"geometry_scale", number(b.geometry_scale)},
          {"rougher", b.rougher},
          {"uneven", b.uneven},
          {"noise_um", number(b.noise_um)},
          {"noise_by_sensor_um", sensors},
          {"correlation", number(b.correlation)},
          {"outliers", b.outliers}};
}

Json length_error(const std::optional<LengthError>& e) {
  if (!e) return {};
  return {{"length_mm", number(e->length_mm)},
          {"error_um", number(kUmPerMm * e->error_mm)},
          {"mpe_um", number(kUmPerMm * e->mpe_mm)}};
}

Json other_methods(const OtherMethods& r) {
  return {{"chi2", {{"p", number(r.chi2_p)}}},
          {"stepwise_bic", {{"members", r.stepwise_bic}}},
          {"best_bayes_factor",
           {{"members", Json::array({r.best_bayes_factor})}, {"probability", number(r.best_bayes_probability)}}}};
}

/// One list per column: a recording has a thousand touches.
Json residuals(const std::vector<ResidualRow>& rows) {
  if (rows.empty()) return {};
  const auto column = [&](auto value) { return array(rows, value); };
  return {{"feature", column([](const ResidualRow& r) { return Json(r.feature); })},
          {"touch", column([](const ResidualRow& r) { return Json(r.touch); })},
          {"setup", column([](const ResidualRow& r) { return Json(r.setup); })},
          {"run", column([](const ResidualRow& r) { return Json(r.run); })},
          {"time_s", column([](const ResidualRow& r) { return number(r.time_s); })},
          {"x_mm", column([](const ResidualRow& r) { return number(r.x_mm); })},
          {"y_mm", column([](const ResidualRow& r) { return number(r.y_mm); })},
          {"z_mm", column([](const ResidualRow& r) { return number(r.z_mm); })},
          {"before_um", column([](const ResidualRow& r) { return number(r.before_um); })},
          {"after_um", column([](const ResidualRow& r) { return number(r.after_um); })}};
}

Json value(const JudgedValue& v) {
  return {{"characteristic", v.characteristic},
          {"program", v.program},
          {"run", v.run},
          {"occurrence", v.occurrence},
          {"unit", v.unit},
          {"value", number(v.value)},
          {"reference", number(v.reference)},
          {"deviation", number(v.deviation)},
          {"u", number(v.u)},
          {"z", number(v.z)},
          {"p", number(v.p)},
          {"lcl", number(v.low)},
          {"ucl", number(v.high)}};
}

}  // namespace

std::string diagnosis_json(const Diagnosis& d, const std::string& machine) {
  const Json out = {
      {"schema", "abbe.diagnosis/1"},
      {"machine", machine},
      {"verdict", d.judged != Judged::plan ? Json(name(d.verdict)) : Json()},
      {"p_value", d.judged == Judged::yes ? number(d.p_value) : Json()},
      {"adequacy_p_value", number(d.adequacy_p)},
      {"touches", d.touches},
      {"values", array(d.values, value)},
      {"effects", array(d.effects, effect)},
      {"location", array(d.location, location)},
      {"unexplained", unexplained(d.unexplained)},
      {"improvement", improvement(d.improvement)},
      {"residuals", d.improvement ? residuals(d.residuals) : Json()},
      {"runner_up",
       d.runner_up ? Json{{"members", d.runner_up->members}, {"log_score_gain", number(d.runner_up->log_score_gain)}}
                   : Json()},
      {"cannot_judge",
       array(d.cannot_judge,
             [](const CannotJudge& c) {
               return Json{
                   {"effect", c.effect}, {"missing", c.missing}, {"constant", c.constant}, {"too_few", c.too_few}};
             })},
      {"smallest_detectable", array(d.smallest_detectable, detectable)},
      {"next_measurement", array(d.next_measurement, next)},
      {"otherwise", d.otherwise.empty() ? Json() : Json(d.otherwise)},
      {"baseline", d.touches > 0 ? baseline(d.baseline) : Json()},
      {"times_known_uncertainty", d.beyond_known ? Json(number(*d.beyond_known)) : Json()},
      {"worst_length", length_error(d.worst_length)},
      {"length_beyond_mpe", length_error(d.beyond)},
      {"rivals", d.other_methods ? other_methods(*d.other_methods) : Json()},
      {"messages", array(d.messages, [](const Diagnostic& m) {
         return Json{{"code", info(m.code).name},
                     {"severity", name(m.severity())},
                     {"file", m.span ? Json(m.file) : Json()},
                     {"line", m.span ? Json(m.place.line) : Json()},
                     {"column", m.span ? Json(m.place.column) : Json()},
                     {"message", m.message},
                     {"help", m.help}};
       })}};
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";  // file names need not be UTF-8
}

std::string improved_machine(const std::string& machine_json, const Diagnosis& d) {
  Json machine = Json::parse(machine_json);
  const std::set<std::size_t, std::greater<>> last_first(d.superseded.begin(), d.superseded.end());
  for (const std::size_t k : last_first) machine["effects"].erase(k);
  for (const EffectSetting& e : d.model_effects) {
    Json values = Json::object();
    for (const auto& [key, v] : e.parameters)
      values[key] = v.word.empty() ? Json{{"value", number(v.value)}, {"u", number(v.u)}} : Json(v.word);
    machine["effects"].push_back({{"name", e.name}, {"parameters", values}});
  }
  if (!d.known_state.empty()) machine["known_state"] = Json::parse(d.known_state);
  return machine.dump(2) + "\n";
}

}  // namespace abbe
