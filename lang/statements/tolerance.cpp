// TOL, OUTPUT, EVAL: what is asked of features. Which arguments a tolerance takes is said by the
// engine's registry.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "engine/tolerances/tolerance.hpp"
#include "lang/statement.hpp"
#include "lang/statements/material.hpp"
#include "lang/statements/words.hpp"

namespace abbe::lang {

namespace {

std::vector<std::string_view> tolerance_words() {
  std::vector<std::string_view> words;
  for (const ToleranceKind* kind : tolerance_kinds()) words.push_back(kind->word);
  return words;
}

bool same_arguments(const Match& a, const Match& b) {
  return std::equal(a.values.begin(), a.values.end(), b.values.begin(), b.values.end(),
                    [](const MatchedValue& x, const MatchedValue& y) {
                      return x.name == y.name && x.number == y.number && x.column == y.column &&
                          upper(x.text) == upper(y.text);
                    });
}

/// Production programs define T(1) hundreds of times. That is legal, so it is said once for each
/// label, and only when the meaning changes.
void note_redefinition(Lowering& lowering, const RawStatement& raw, const ToleranceSymbol& known) {
  if (!lowering.reported_words.insert("T:" + upper(raw.label->name)).second) return;
  lowering.warn(Code::N0611, raw.label->span,
                fmt::format("T({}) was another tolerance in line {}", raw.label->name, known.line),
                "each OUTPUT uses the definition above it");
}

/// Programs write angularity as ANGL too: the angle of a cone has no datum.
bool is_angularity(const RawStatement& raw, std::string_view word) {
  return same_label(word, "ANGL") && std::any_of(raw.arguments.begin(), raw.arguments.end(), [](const RawArgument& a) {
           return a.kind == RawArgument::Kind::label && a.label.kind == "DAT";
         });
}

void define_tolerance(Lowering& lowering, const RawStatement& raw, const Match& match) {
  const MatchedValue& word = *match.find("tolerance");
  const ToleranceKind* kind = find_tolerance_kind(is_angularity(raw, word.text) ? "ANGLR" : word.text);
  if (!kind) return unknown_kind(lowering, word, "TOL", "tolerance", tolerance_words());
  std::optional<Match> rest =
      lowering.match(kind->signature, raw, fmt::format("TOL/{}", kind->word), match.used, Varying::taken);
  if (!rest) return;
  if (const MatchedValue* unit = rest->find("unit_zone"))
    lowering.warn(Code::W0122, unit->span, "the zone per unit of area is not evaluated",
                  "the value and its uncertainty are of the flatness of the whole surface");
  if (const MatchedValue* zone = rest->find("zone"); zone && !zone->column.valid() && zone->number < 0)
    lowering.warn(Code::W0264, zone->span, "the zone is below 0: no value conforms",
                  "a zone is a width without a sign; 0 asks for the value alone");
  const MatchedValue *low = rest->find("lower"), *high = rest->find("upper");
  if (low && high && !low->column.valid() && !high->column.valid() && low->number > high->number)
    lowering.warn(Code::W0262, low->span, "the lower limit is above the upper one: no value conforms",
                  "the lower deviation stands first, with its sign: -0.01,0.02");
  const ToleranceSymbol* known = lowering.symbols.tolerances.find(upper(raw.label->name));
  const bool same = known && known->kind == kind && same_arguments(known->match, *rest);
  if (known && !same) note_redefinition(lowering, raw, *known);
  auto instances = same ? known->instances : std::make_shared<std::map<std::vector<int>, plan::ToleranceId>>();
  lowering.symbols.tolerances.set(
      upper(raw.label->name),
      {kind, *rest, lowering.here().second, raw.label->name, std::move(instances), written_form(raw, *rest)});
}

/// The features and datums that the labels of the tolerance mean now; -1 for one that cannot be
/// used.
std::vector<int> operands_now(Lowering& lowering, const ToleranceSymbol& symbol, const MatchedValue& use) {
  std::vector<int> ids;
  for (const MatchedValue& v : symbol.match.values) {
    if (v.type != ValueType::feature && v.type != ValueType::datum) continue;
    LabelRef label = v.label;
    label.span = use.span;  // the mistake shows where the tolerance is used
    const auto id = v.type == ValueType::feature ? lowering.feature(label) : lowering.datum(label);
    ids.push_back(id ? id->value : -1);
  }
  return ids;
}

/// The definition with its labels resolved to what they mean now; the same one for the same
/// meaning.
std::optional<plan::ToleranceId> instance(Lowering& lowering, const ToleranceSymbol& symbol, const MatchedValue& use) {
  const std::vector<int> ids = operands_now(lowering, symbol, use);
  if (lowering.failed) return std::nullopt;
  const plan::ToleranceId id{static_cast<int>(lowering.out.plan.tolerances.size())};
  const auto [known, is_new] = symbol.instances->emplace(ids, id);
  if (!is_new) return known->second;
  lowering.out.plan.tolerances.push_back(
      {symbol.label, symbol.kind, *lowering.arguments(symbol.match), Lowering::varying(symbol.match)});
  return id;
}

/// One tolerance of OUTPUT or EVAL: a characteristic, when it suits the features.
void evaluate(Lowering& lowering, const RawStatement& raw, const std::vector<plan::FeatureId>& features,
              const MatchedValue& use) {
  const ToleranceSymbol* symbol = lowering.tolerance(use.label);
  if (!symbol) return;
  const ToleranceKind& kind = *symbol->kind;
  if (static_cast<int>(features.size()) != kind.features)
    return lowering.error(Code::E0213, use.span,
                          fmt::format("{} takes {} feature{}, {} given", kind.word, kind.features,
                                      kind.features == 1 ? "" : "s", features.size()),
                          fmt::format("write {}/{},{}({})", raw.word, kind.features == 1 ? "FA(a)" : "FA(a),FA(b)",
                                      use.label.kind, use.label.name));
  const std::optional<plan::ToleranceId> tolerance = instance(lowering, *symbol, use);
  if (!tolerance) return;
  const Arguments& arguments = lowering.out.plan[*tolerance].arguments;
  std::vector<Shape> shapes;
  for (const plan::FeatureId id : features) shapes.push_back(lowering.out.plan[id].kind->shape);
  for (const int id : arguments.features("reference"))
    shapes.push_back(lowering.out.plan[plan::FeatureId{id}].kind->shape);
  if (const char* reason = kind.applies(arguments, shapes))
    return lowering.error(Code::E0214, use.span, fmt::format("{} cannot be evaluated here: {}", kind.word, reason),
                          fmt::format("`abbe explain {}` says what it applies to", kind.word));
  const plan::CharacteristicId id{static_cast<int>(lowering.out.plan.characteristics.size())};
  lowering.out.plan.characteristics.push_back(
      {features, *tolerance, lowering.here().second, material_conditions(lowering, *symbol, features.front(), use)});
  lowering.emit(plan::Evaluate{id});
}

/// OUTPUT/F(x) puts out what was programmed. A tolerance is of what was measured.
bool is_nominal_alone(const Match& match, const MatchedValue& v) {
  return v.type == ValueType::feature && v.label.kind == "F" && !match.has("tolerance");
}

/// What the result file repeats of an OUTPUT without saying more of it: nominals, sensors, and labels of reports and
/// of what identifies the part.
std::vector<std::string> only_named(const Match& match) {
  std::vector<std::string> labels;
  for (const MatchedValue& v : match.values)
    if (v.type == ValueType::sensor || v.type == ValueType::label || is_nominal_alone(match, v))
      labels.push_back(written(v.label));
  return labels;
}

/// What goes to the result file: the features, and the characteristics evaluated from `first` on.
void emit_output(Lowering& lowering, const std::vector<plan::FeatureId>& features, std::size_t first,
                 const Match& match) {
  plan::Output out{features, {}, only_named(match)};
  for (std::size_t k = first; k < lowering.out.plan.characteristics.size(); ++k)
    out.characteristics.push_back({static_cast<int>(k)});
  if (!features.empty() || !out.also.empty()) lowering.emit(out);
}

/// "A, B" as written, for what is lost.
std::string names_of_features(const Match& match) {
  std::string names;
  for (const MatchedValue& v : match.values)
    if (v.type == ValueType::feature) names += (names.empty() ? "" : ", ") + v.label.name;
  return names;
}

/// The tolerances of size of this statement serve its other tolerances, whatever their order.
void remember_sizes(Lowering& lowering, plan::FeatureId feature, const std::vector<const MatchedValue*>& tolerances) {
  for (const MatchedValue* use : tolerances) {
    const ToleranceSymbol* symbol = lowering.symbols.tolerances.find(upper(use->label.name));
    if (!symbol) continue;
    const Shape shape = lowering.out.plan[feature].kind->shape;
    if (symbol->kind->size_factor == 0 || symbol->kind->applies({}, {&shape, 1})) continue;
    if (const auto id = instance(lowering, *symbol, *use)) remember_size(lowering, feature, *id);
  }
}

/// Behind the features and tolerances, or alone, may stand what skipped statements name, and reports:
/// they are for the head of a real result file.
void check_report_label(Lowering& lowering, const MatchedValue& v) {
  if (v.label.kind == "R" || v.label.kind == "V" || lowering.skipped_labels.contains(v.label.kind)) return;
  static const std::set<std::string_view> identifying = {"CC", "CI", "CS", "DI", "DS", "DV", "FI", "FS", "LI",
                                                         "MD", "OP", "PC", "PL", "PN", "PR", "PS", "PV", "Q"};
  if (identifying.contains(v.label.kind))
    return lowering.warn(Code::W0122, v.span, fmt::format("no statement above defines {}", written(v.label)),
                         "the result file repeats the label; nothing depends on it");
  lowering.error(Code::E0106, v.span, fmt::format("OUTPUT puts out no {}({}) here", v.label.kind, v.label.name),
                 "expected features FA(...), then their tolerances TA(...), then R(...); or D(...) or S(...)");
}

/// Every tolerance is tried by itself, so that one mistake does not take the others away.
void output(Lowering& lowering, const RawStatement& raw, const Match& match) {
  std::vector<plan::FeatureId> features;
  std::vector<const MatchedValue*> tolerances;
  for (const MatchedValue& v : match.values) {
    if (v.type == ValueType::tolerance) tolerances.push_back(&v);
    if (is_nominal_alone(match, v))
      lowering.defined_feature(v.label);
    else if (v.type == ValueType::feature)
      features.push_back(lowering.actual_feature(v.label).value_or(plan::FeatureId{}));
    if (v.type == ValueType::frame)
      if (const auto frame = lowering.frame(v.label)) lowering.emit(plan::OutputFrame{*frame});
    if (v.type == ValueType::sensor) lowering.sensor(v.label);
    if (v.type == ValueType::label) check_report_label(lowering, v);
  }
  if (!lowering.failed && !tolerances.empty() && !lowering.doubt().empty()) lowering.fail(lowering.doubt());
  const std::string feature = names_of_features(match);
  const std::size_t first_characteristic = lowering.out.plan.characteristics.size();
  const bool features_failed = lowering.failed;
  const std::string features_failure = lowering.failure;
  if (!features_failed && features.size() == 1) remember_sizes(lowering, features[0], tolerances);
  bool any_failed = features_failed;
  std::string first_failure = features_failure;
  for (const MatchedValue* use : tolerances) {
    lowering.failed = features_failed;
    lowering.failure = features_failure;
    if (!features_failed) evaluate(lowering, raw, features, *use);
    if (!lowering.failed) continue;
    lowering.out.lost.push_back({lowering.here().second, feature,
                                 fmt::format("{}({}): {}", use->label.kind, use->label.name, lowering.failure)});
    if (!any_failed) first_failure = lowering.failure;
    any_failed = true;
  }
  if (raw.word == "OUTPUT" && !features_failed) emit_output(lowering, features, first_characteristic, match);
  if (tolerances.empty() && any_failed) lowering.out.lost.push_back({lowering.here().second, feature, first_failure});
  lowering.failed = any_failed;
  lowering.failure = first_failure;
}

}  // namespace

extern const Statement kTol, kOutput, kEval;

const Statement kTol = {
    .word = "TOL",
    .label = "T",
    .signature = "tolerance:word, ...",
    .help = "Defines a tolerance. Its datums may be bound later, before OUTPUT or EVAL.",
    .example = "T(ROUND)=TOL/CIRLTY,0.01",
    .source = "ISO 22093, TOL",
    .lower = define_tolerance,
};
const Statement kOutput = {
    .word = "OUTPUT",
    .signature =
        "( feature:feature, { feature:feature }, { tolerance:tolerance } ; frame:frame ; sensor:sensor "
        "; report:label ), { report:label }",
    .help =
        "Puts out measured features; each tolerance is evaluated and its value gets an uncertainty. What "
        "identifies the part or the report, PN(1) of PARTID, is only repeated in the result file, as a sensor and a nominal F(l) are.",
    .example = "OUTPUT/FA(BORE),TA(ROUND),TA(SIZE)",
    .source = "ISO 22093, OUTPUT",
    .lower = output,
    .doubt = Doubt::characteristic,
};
const Statement kEval = {
    .word = "EVAL",
    .signature = "feature:feature, { feature:feature }, tolerance:tolerance, { tolerance:tolerance }",
    .help = "Evaluates tolerances without putting out the features.",
    .example = "EVAL/FA(BORE),T(ROUND)",
    .source = "ISO 22093, EVAL",
    .lower = output,
    .doubt = Doubt::characteristic,
};

}  // namespace abbe::lang
