// The report for programs, schema "abbe.run/1". A key once published stays; every number is in the
// unit that its key, or the characteristic's "unit", names.
#include "engine/report/json_value.hpp"
#include "engine/report/writer.hpp"
#include "engine/report/writers/sentences.hpp"

namespace abbe {

namespace {

Json pair(std::optional<double> low, std::optional<double> high) { return Json::array({number(low), number(high)}); }

Json contributions(const CharacteristicReport& c) {
  Json out = Json::object();
  for (const auto& contribution : c.contributions) out[contribution.name] = number(known(c, contribution.share));
  return out;
}

Json budget(const CharacteristicReport& c, const std::vector<CharacteristicReport::BudgetLine>& lines) {
  Json out = Json::array();
  for (const auto& line : lines)
    out.push_back({{"name", line.name}, {"share", number(known(c, line.share))}, {"u", number(known(c, line.u))}});
  return out;
}

Json decision(const CharacteristicReport::Decision& d) {
  return {{"rule", kDecisionRule},
          {"probability", kProvenProbability},
          {"guard_band", number(d.guard_band)},
          {"acceptance_limits", d.guard_band ? pair(d.lower, d.upper) : Json()},
          {"verdict", name(d.verdict)},
          {"tolerance_to_uncertainty", number(d.tolerance_to_uncertainty)}};
}

/// Nulls where the uncertainty is not known.
Json intervals(const CharacteristicReport& c, const Interval& symmetric, const Interval& shortest) {
  const auto of = [&](const Interval& i) { return pair(known(c, i.low), known(c, i.high)); };
  return {{"symmetric", of(symmetric)}, {"shortest", of(shortest)}};
}

Json characteristic(const CharacteristicReport& c) {
  const Summary& s = c.summary;
  const auto of_u = [&](std::optional<double> figure) { return number(known(c, figure)); };
  Json out = {
      {"feature", c.features},
      {"tolerance", c.tolerance},
      {"kind", c.kind},
      {"unit", c.unit},
      {"line", c.line},
      {"occurrence", c.occurrence},
      {"nominal", number(c.nominal)},
      {"reference", number(c.reference)},
      {"mean", number(s.mean)},
      {"u", of_u(s.u)},
      {"lcl", of_u(c.lcl)},
      {"ucl", of_u(c.ucl)},
      {"interval95", intervals(c, s.symmetric, s.shortest)},
      {"monte_carlo_error",
       {{"mean", of_u(s.mean_error)}, {"u", of_u(s.u_error)}, {"lcl", of_u(s.low_error)}, {"ucl", of_u(s.high_error)}}},
      {"tolerance_limits", pair(c.lower, c.upper)},
      {"conformance_probability", number(c.conformance_probability)},
      {"decision", c.decision ? decision(*c.decision) : Json()},
      {"contributions", contributions(c)},
      {"trapped", c.trapped},
      {"evaluated", c.evaluated}};
  if (c.interval) {
    out["interval"] = {{"coverage", c.interval->coverage}};
    out["interval"].update(intervals(c, c.interval->symmetric, c.interval->shortest));
  }
  if (!c.budget.empty()) out["budget"] = budget(c, c.budget);
  if (!c.alignment_split.empty()) out["alignment_split"] = budget(c, c.alignment_split);
  return out;
}

Json message(const Diagnostic& d) {
  return {{"code", info(d.code).name},
          {"severity", name(d.severity())},
          {"line", d.span ? Json(d.place.line) : Json()},
          {"column", d.span ? Json(d.place.column) : Json()},
          {"message", d.message},
          {"help", d.help}};
}

Json influence(const Influence& i) {
  Json out = {{"name", i.name}, {"status", name(i.status)}};
  if (i.status == InfluenceStatus::bounded) out.update({{"at_most_um", number(i.at_most_um)}, {"source", i.source}});
  return out;
}

template <class T, class F>
Json list(const std::vector<T>& items, F convert) {
  Json out = Json::array();
  for (const T& item : items) out.push_back(convert(item));
  return out;
}

std::string write_json(const RunReport& r) {
  const ScreeningCounts& m = r.machines;
  const Json report = {{"schema", "abbe.run/1"},
                       {"program", r.program},
                       {"machine", r.machine},
                       {"workpiece", r.workpiece ? Json(*r.workpiece) : Json()},
                       {"errors_added_to", r.recorded_points ? "recorded points" : "nominal points"},
                       {"effects_use", r.effect_use ? Json(name(*r.effect_use)) : Json()},
                       {"seed", r.seed},
                       {"version", r.version},
                       {"cycle_time_s", number(r.cycle_time_s)},
                       {"machines",
                        {{"used", m.used},
                         {"generated", m.generated},
                         {"failed_mpe", m.failed_mpe},
                         {"too_small", m.too_small},
                         {"share_accepted", number(m.share_accepted())}}},
                       {"characteristics", list(r.characteristics, characteristic)},
                       {"lost",
                        list(r.lost,
                             [](const auto& l) {
                               return Json{{"line", l.line}, {"feature", l.feature}, {"reason", l.reason}};
                             })},
                       {"traps",
                        list(r.traps,
                             [](const Trap& t) {
                               return Json{{"machine", t.machine}, {"line", t.line}, {"reason", t.reason}};
                             })},
                       {"influences", list(r.influences, influence)},
                       {"messages", list(r.messages, message)}};
  // Labels keep the bytes of the program, which may be Latin-1: what is not UTF-8 is replaced.
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

extern const ReportWriter json_writer{"json", write_json};

}  // namespace abbe
