#include "lang/lowering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "lang/vocabulary.hpp"

namespace abbe::lang {

std::string spoilt_key(std::string_view kind, std::string_view name) {
  return fmt::format("{}:{}", shared_kind(kind), upper(name));
}

std::string chain(std::string consequence, std::string_view cause) {
  constexpr std::string_view kArrow = " <- ", kGap = "... <- ";
  constexpr int kLongest = 4;
  int links = 1;
  std::size_t last = 0;
  for (std::size_t at = cause.find(kArrow); at != std::string_view::npos; at = cause.find(kArrow, last)) {
    last = at + kArrow.size();
    ++links;
  }
  const bool gap = links >= kLongest;
  return fmt::format("{}{}{}{}", consequence, kArrow, gap ? kGap : "", gap ? cause.substr(last) : cause);
}

void Lowering::add(Diagnostic d) {
  const std::uint32_t at = d.span ? d.span->begin : 0;
  if (!reported_.insert({d.code, file, at}).second) return;
  if (place) out.calls.try_emplace({d.file, at}, place->first);
  if (!call.empty()) d.help = fmt::format("{}{}{}", d.help, d.help.empty() ? "" : " ", call);
  sink.add(std::move(d));
}

void Lowering::error(Code code, Span span, std::string message, std::string help, std::string replacement) {
  const bool first = !failed;
  fail(message);
  if (first) failure_line = file->place(span.begin).line;
  add(diagnostic_at(*file, span, code, std::move(message), std::move(help), std::move(replacement)));
}

void Lowering::warn(Code code, Span span, std::string message, std::string help, std::string replacement) {
  add(diagnostic_at(*file, span, code, std::move(message), std::move(help), std::move(replacement)));
}

void Lowering::mistake(const Mistake& m) {
  error(m.code, statement->code->span(m.begin, m.end), m.message, m.help, m.replacement);
}

void Lowering::fail(std::string reason) {
  if (!failed) {
    failure = std::move(reason);
    failure_line = statement ? statement->line : 0;
  }
  failed = true;
}

namespace {

/// Finds the variables of a program for its expressions.
class VariablesOf : public Names {
 public:
  explicit VariablesOf(Lowering& lowering) : lowering_(lowering) {}
  std::optional<Value> variable(std::string_view name, const std::optional<Value>& index) override {
    Variable* found = find_variable(lowering_, name);
    if (!found) return std::nullopt;
    try {
      return read(lowering_, *found, index);
    } catch (Mistake& mistake) {
      mistake.of_variable = true;
      throw;
    }
  }
  std::string near(std::string_view name) override {
    std::vector<std::string_view> names;
    for (const auto& [key, v] : lowering_.variables) names.push_back(v.name);
    return nearest_word(name, names);
  }
  Texts& texts() override { return lowering_.texts; }

 private:
  Lowering& lowering_;
};

}  // namespace

std::optional<Value> Lowering::value(const RawArgument& argument) {
  VariablesOf names(*this);
  Evaluation result = evaluate(statement->code->text(), argument.begin, argument.end, names);
  if (Value* v = std::get_if<Value>(&result)) return std::move(*v);
  mistake(std::get<Mistake>(result));
  return std::nullopt;
}

std::optional<Match> Lowering::match(std::string_view text, const RawStatement& raw, std::string_view what,
                                     std::size_t first, Varying takes) {
  auto it = signatures_.find(text);
  if (it == signatures_.end()) it = signatures_.emplace(text, parse_signature(text)).first;
  const std::span<const RawArgument> arguments = std::span(raw.arguments).subspan(first);
  VariablesOf names(*this);
  auto result = lang::match(it->second, arguments, units,
                            [&](const RawArgument& a) { return evaluate(raw.code->text(), a.begin, a.end, names); });
  if (const Mismatch* mismatch = std::get_if<Mismatch>(&result)) {
    if (mismatch->mistake) {
      mistake(*mismatch->mistake);
    } else {
      Diagnostic d = describe(*mismatch, arguments, what, first, raw.span, *file);
      fail(d.message);
      add(std::move(d));
    }
    return std::nullopt;
  }
  for (MatchedValue& v : std::get<Match>(result).values) {
    if (!v.value || v.type == ValueType::value || v.type == ValueType::condition) continue;
    if (takes == Varying::refused) {
      error(Code::E0231, v.span,
            fmt::format("{} must be known before the machine runs, '{}' depends on a measured value", what, v.text),
            "use a number, or a variable that nothing measured goes into");
      return std::nullopt;
    }
    v.column = evaluated(v.value->parts[0]);
  }
  warn_of_lengths(std::get<Match>(result));
  return std::move(std::get<Match>(result));
}

namespace {

/// Whether these three values of a match are the components i, j and k of one direction, as signatures name
/// them, and known.
bool is_direction(std::span<const MatchedValue> v) {
  const std::string& i = v[0].name;
  const std::size_t at = i.find('i');
  if (at == std::string::npos || i.size() > 2) return false;
  const auto is_component = [&](const MatchedValue& value, char letter) {
    std::string name = i;
    name[at] = letter;
    return value.name == name && value.type == ValueType::number && !value.column.valid();
  };
  return is_component(v[0], 'i') && is_component(v[1], 'j') && is_component(v[2], 'k');
}

}  // namespace

/// A direction is divided by its length, so a number too many or too few before it would go unnoticed.
void Lowering::warn_of_lengths(const Match& match) {
  constexpr double kSlack = 0.01;  // programs write directions with two decimals
  for (std::size_t at = 0; at + 2 < match.values.size(); ++at) {
    const auto v = std::span(match.values).subspan(at, 3);
    if (!is_direction(v)) continue;
    const double length = norm(Vec3{v[0].number, v[1].number, v[2].number});
    if (length > 0 && std::fabs(length - 1) > kSlack)
      warn(Code::W0260, v[0].span,
           fmt::format("the direction {:g},{:g},{:g} has length {:.4g}", v[0].number, v[1].number, v[2].number, length),
           "directions have length 1; it is divided by its length. Is a number missing, or one too many?");
  }
}

std::vector<plan::VaryingNumber> Lowering::varying(const Match& match) {
  std::vector<plan::VaryingNumber> out;
  std::map<std::string, int> counts;
  for (const MatchedValue& v : match.values) {
    if (v.type > ValueType::integer) continue;
    const int index = counts[v.name]++;
    if (v.column.valid()) out.push_back({v.name, index, v.column});
  }
  return out;
}

namespace {

/// ISO 22093 counts polar coordinates in the working plane; here they are in that of x and y.
void refuse_other_plane(Lowering& lowering, const Match& match) {
  const MatchedValue* radius = match.find("r");
  const std::string* plane = lowering.settings.find("WKPLAN");
  if (!radius || !plane || upper(*plane) == "XYPLAN") return;
  lowering.error(Code::E0106, radius->span,
                 fmt::format("POL counts in the plane of x and y here, and WKPLAN chose {}", upper(*plane)),
                 "give x,y,z with CART, or write WKPLAN/XYPLAN before it");
}

}  // namespace

std::optional<Arguments> Lowering::arguments(const Match& match) {
  refuse_other_plane(*this, match);
  Arguments values;
  for (const MatchedValue& v : match.values) {
    if (v.type == ValueType::feature || v.type == ValueType::datum) {
      const auto id = v.type == ValueType::feature ? feature(v.label) : datum(v.label);
      if (id) values.add_feature(v.name, id->value);
    } else if (v.type <= ValueType::integer) {
      values.add_number(v.name, v.number);
    } else {
      values.add_text(v.name, v.text);
    }
  }
  return failed ? std::nullopt : std::optional(std::move(values));
}

template <class Meaning>
const Meaning* Lowering::find(const Symbols::Labels<Meaning>& labels, std::string_view kind, const LabelRef& label,
                              std::string_view next_step) {
  if (const std::string* spoilt = symbols.spoilt.find(spoilt_key(label.kind, label.name))) {
    fail(chain(fmt::format("{} {} is not usable", kind, written(label)), *spoilt));
    return nullptr;
  }
  const Meaning* meaning = labels.find(upper(label.name));
  if (meaning && symbols.ambiguous.count(spoilt_key(label.kind, label.name))) {
    error(Code::E0238, label.span, fmt::format("which {} {} means depends on a measured value", kind, written(label)),
          "define it once, or use it on each path before they meet");
    return nullptr;
  }
  if (meaning) return meaning;
  std::vector<std::string_view> names;
  labels.each([&](const std::string& name, const Meaning&) { names.push_back(name); });
  const std::string near = nearest_word(label.name, names);
  error(Code::E0201, label.span, fmt::format("{} {} is not defined above", kind, written(label)),
        near.empty() ? std::string(next_step) : fmt::format("did you mean {}({})?", label.kind, near),
        near.empty() ? "" : fmt::format("{}({})", label.kind, near));
  return nullptr;
}

std::optional<plan::FeatureId> Lowering::defined_feature(const LabelRef& label) {
  const plan::FeatureId* id =
      find(symbols.features, "feature", label, "define it with F(name)=FEAT/... before this line");
  return id ? std::optional(*id) : std::nullopt;
}

std::optional<plan::FeatureId> Lowering::feature(const LabelRef& label) {
  if (label.kind != "F") return actual_feature(label);
  const std::optional<plan::FeatureId> of = defined_feature(label);
  if (!of) return of;
  const auto [known, is_new] =
      nominals_.emplace(of->value, plan::FeatureId{static_cast<int>(out.plan.features.size())});
  if (is_new) out.plan.features.push_back(plan::FeatureDef(out.plan[*of]));
  emit(plan::TakeNominal{known->second, *of});
  return known->second;
}

std::optional<plan::FeatureId> Lowering::actual_feature(const LabelRef& label) {
  if (label.kind == "F") {
    error(Code::E0106, label.span, fmt::format("F({}) is the nominal, and this asks for what was measured", label.name),
          fmt::format("write FA({})", label.name), fmt::format("FA({})", label.name));
    return std::nullopt;
  }
  const std::optional<plan::FeatureId> id = defined_feature(label);
  if (!id) return id;
  const ActualState state = actual(*id);
  if (!state.spoilt.empty()) {
    fail(chain(fmt::format("FA({}) is not measured", label.name), state.spoilt));
    return std::nullopt;
  }
  if (state.present || looping > 0) return id;  // a turn of a loop may have measured it
  const bool inside = measuring && measuring->feature == *id;
  error(Code::E0202, label.span, fmt::format("{} was not measured or constructed above", written(label)),
        inside ? "use it after ENDMES"
               : fmt::format("measure F({0}) with MEAS..ENDMES or construct it with CONST first", label.name));
  return std::nullopt;
}

std::optional<plan::FeatureId> Lowering::datum(const LabelRef& label) {
  if (label.kind == "FA") return actual_feature(label);
  std::string next_step = "bind it with DATDEF/FA(feature),DAT(name)";
  if (label.name.find('-') != std::string::npos)
    next_step =
        fmt::format("construct the common axis or plane, then bind it with DATDEF/FA(both),DAT({})", label.name);
  const plan::FeatureId* id = find(symbols.datums, "datum", label, next_step);
  return id ? std::optional(*id) : std::nullopt;
}

std::optional<plan::FrameId> Lowering::frame(const LabelRef& label) {
  const plan::FrameId* id = find(symbols.frames, "coordinate system", label, "define it with D(name)=DATSET/...");
  return id ? std::optional(*id) : std::nullopt;
}

std::optional<plan::SensorId> Lowering::sensor(const LabelRef& label) {
  const plan::SensorId* id = find(symbols.sensors, "sensor", label,
                                  "define it with SNSDEF, or write SA(name) for a sensor of the machine file");
  return id ? std::optional(*id) : std::nullopt;
}

void Lowering::sensor_of_machine_file(const LabelRef& label) {
  const std::string key = upper(label.name);
  if (symbols.sensors.has(key) || symbols.spoilt.has(spoilt_key(label.kind, label.name))) return;
  plan::SensorDef def;
  def.label = label.name;
  def.from_machine_file = true;
  def.span = place ? place->first : label.span;
  symbols.sensors.set(key, {static_cast<int>(out.plan.sensors.size())});
  out.plan.sensors.push_back(std::move(def));
}

const ToleranceSymbol* Lowering::tolerance(const LabelRef& label) {
  return find(symbols.tolerances, "tolerance", label, "define it with T(name)=TOL/... before this line");
}

std::pair<Span, int> Lowering::here() const { return place.value_or(std::pair{statement->span, statement->line}); }

void Lowering::emit(plan::Action action) {
  const auto [span, line] = here();
  out.plan.operations.push_back({std::move(action), span, line});
}

plan::FrameId Lowering::new_frame(const RawStatement& raw) {
  const std::string key = upper(raw.label->name);
  const plan::FrameId* known = symbols.frames.find(key);
  if (parted > 0 && known) return *known;
  const plan::FrameId id{static_cast<int>(out.plan.frames.size())};
  out.plan.frames.push_back({raw.label->name});
  symbols.frames.set(key, id);
  return id;
}

std::vector<FormItem> written_form(const RawStatement& raw, const Match& match) {
  std::vector<FormItem> form;
  for (const RawArgument& a : raw.arguments) {
    FormItem item{a.kind == RawArgument::Kind::word ? a.word : a.text, "", false, {}, {}};
    for (const MatchedValue& v : match.values) {
      if (v.span != a.span) continue;
      item.name = v.name;
      item.is_number = v.type <= ValueType::integer;
      item.type = v.type;
      if (item.is_number) item.operand = Lowering::operand(v);
    }
    form.push_back(std::move(item));
  }
  return form;
}

void Lowering::define(const RawStatement& raw, plan::FeatureDef def, const Match& match) {
  const std::string key = upper(raw.label->name);
  const plan::FeatureId own{static_cast<int>(out.plan.features.size())};
  const auto suits = [&](plan::FeatureId other) {
    return out.plan[other].kind == def.kind && out.plan[other].inner == def.inner;
  };
  plan::FeatureId id = own;
  if (parted > 0) {
    const plan::FeatureId* here = symbols.features.find(key);
    const auto [elsewhere, first] = features_of_paths_.emplace(std::pair(key, parting), own);
    if (here && suits(*here))
      id = *here;
    else if (!first && suits(elsewhere->second))
      id = elsewhere->second;
  }
  out.plan.features.push_back(std::move(def));
  symbols.features.set(key, id);
  actuals.set(id.value, {});
  forms[id.value] = written_form(raw, match);
  emit(plan::DefineFeature{id, id == own ? plan::FeatureId{} : own});
}

ActualState Lowering::actual(plan::FeatureId id) const {
  const ActualState* state = actuals.find(id.value);
  return state ? *state : ActualState{};
}

void Lowering::refuse_varying(std::string_view setting, Span at) {
  error(Code::E0238, at, fmt::format("which {} holds here depends on a measured value", setting),
        fmt::format("write {} again before this, or use it on each path before they meet", setting));
}

plan::ColumnId Lowering::evaluated(const plan::Expression& value) {
  const plan::ColumnId column{out.plan.columns++};
  emit(plan::Assign{column, value});
  return column;
}

plan::ColumnId Lowering::columns_of(const std::string& slot, int count) {
  const auto [it, is_new] = columns_.emplace(slot, plan::ColumnId{out.plan.columns});
  if (is_new) out.plan.columns += count;
  return it->second;
}

plan::Expression Lowering::expression(const plan::Operand& o) {
  return {o.column.valid() ? plan::Instruction(plan::PushColumn{o.column}) : plan::PushConstant{o.constant}};
}

plan::Operand Lowering::operand(const plan::Expression& e) {
  const double* known = plan::constant(e);
  return known ? plan::Operand{*known, {}} : plan::Operand{0, evaluated(e)};
}

plan::Point Lowering::polar(const Match& match) {
  using namespace plan;
  refuse_other_plane(*this, match);
  const Expression r = expression(operand(*match.find("r"))), a = expression(operand(*match.find("a")));
  return {operand(combine(Op2::multiply, combine(Op1::cos, a), r)),
          operand(combine(Op2::multiply, combine(Op1::sin, a), r)), operand(*match.find("h"))};
}

plan::Point Lowering::point(const Match& match, std::string_view first) {
  const auto it =
      std::find_if(match.values.begin(), match.values.end(), [&](const MatchedValue& v) { return v.name == first; });
  ABBE_CHECK(match.values.end() - it >= 3);
  return {operand(it[0]), operand(it[1]), operand(it[2])};
}

std::string Lowering::blame() const { return fmt::format("line {}: {}", failure_line, failure); }

std::string Lowering::doubt() const {
  if (!flow_doubt.empty()) return chain("it is not known whether this is run", flow_doubt);
  if (!unit_doubt.empty()) return chain("the units are in doubt", unit_doubt);
  if (!frame_doubt.empty()) return chain("the coordinate system is in doubt", frame_doubt);
  return sensor_doubt.empty() ? "" : chain("the sensor is in doubt", sensor_doubt);
}

std::string Lowering::measuring_doubt() const {
  if (std::string general = doubt(); !general.empty()) return general;
  const bool points_given = measuring && measuring->touches > 0;
  for (const auto& [setting, reason] : setting_doubts) {
    // of sensors defined after it; of default touches
    if (setting == "SNSMNT" || (setting == "MODE" && points_given)) continue;
    return chain(fmt::format("what {} sets is in doubt", setting), reason);
  }
  return "";
}

}  // namespace abbe::lang
