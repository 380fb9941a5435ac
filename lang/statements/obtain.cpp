// OBTAIN: what a measured feature or an evaluated tolerance is, argument by argument.
//
// Arguments are counted as the statement in the result file has them, its word being the first: in
// FA(P)=FEAT/POINT,CART,x,y,z,i,j,k the x is number 4. Of a feature the form is that of its FEAT statement; of a tolerance
// that of the result file: TA(T)=TOL/DIAM,value,INTOL.
#include <fmt/format.h>

#include <array>

#include "lang/statement.hpp"
#include "lang/statements/target.hpp"

namespace abbe::lang {

namespace {

using plan::Op1, plan::Op2, plan::Quantity;

struct Readable {
  std::string_view name;  ///< of an argument of FEAT
  Quantity quantity;
  double times = 1;
};
constexpr std::array kReadable = {
    Readable{"x", Quantity::x},           Readable{"y", Quantity::y},           Readable{"z", Quantity::z},
    Readable{"i", Quantity::i},           Readable{"j", Quantity::j},           Readable{"k", Quantity::k},
    Readable{"h", Quantity::z},           Readable{"diam", Quantity::radius, 2}, Readable{"radius", Quantity::radius},
    Readable{"majdia", Quantity::radius, 2}, Readable{"mindia", Quantity::minor_radius, 2}, Readable{"angle", Quantity::half_angle, 2},
    Readable{"length", Quantity::length}, Readable{"x1", Quantity::begin_x},    Readable{"y1", Quantity::begin_y},
    Readable{"z1", Quantity::begin_z},    Readable{"x2", Quantity::end_x},      Readable{"y2", Quantity::end_y},
    Readable{"z2", Quantity::end_z}};

plan::Expression obtained(Lowering& lowering, plan::FeatureId feature, Quantity quantity) {
  const plan::ColumnId column{lowering.out.plan.columns++};
  lowering.emit(plan::Obtain{column, feature, quantity});
  return {plan::PushColumn{column}};
}

plan::Expression scaled(plan::Expression e, double factor) {
  return factor == 1 ? e : combine(Op2::multiply, std::move(e), {plan::PushConstant{factor}});
}

/// mm and rad back to the units of the program.
double to_program(ValueType type, const Units& units) {
  return type == ValueType::length ? 1 / units.mm_per_unit : type == ValueType::angle ? 1 / units.rad_per_unit : 1;
}

Value word_value(Lowering& lowering, const std::string& word) { return lowering.texts.value(word); }

/// The actual of one number of the form; nothing when it cannot be read.
std::optional<Value> actual_number(Lowering& lowering, plan::FeatureId feature, const FormItem& item) {
  const double unit = to_program(item.type, lowering.units);
  if (item.name == "r" || item.name == "a") {
    const plan::Expression x = obtained(lowering, feature, Quantity::x), y = obtained(lowering, feature, Quantity::y);
    const plan::Expression squares = combine(Op2::add, combine(Op2::multiply, x, x), combine(Op2::multiply, y, y));
    return Value{Type::real, {scaled(item.name == "r" ? combine(Op1::sqrt, squares) : combine(Op2::atan2, y, x), unit)}};
  }
  for (const Readable& r : kReadable)
    if (r.name == item.name) return Value{Type::real, {scaled(obtained(lowering, feature, r.quantity), r.times * unit)}};
  return std::nullopt;
}

std::optional<Value> from_feature(Lowering& lowering, const MatchedValue& label, const MatchedValue& index) {
  const bool actual = label.label.kind == "FA";
  const auto feature = actual ? lowering.actual_feature(label.label) : lowering.defined_feature(label.label);
  if (!feature) return std::nullopt;
  const plan::FeatureDef& def = lowering.out.plan[*feature];
  const std::vector<FormItem>& form = lowering.forms[feature->value];
  const double k = index.number - 2;  // FEAT is 1, the kind 2
  if (index.number == 1) return word_value(lowering, "FEAT");
  if (k >= 0 && k < static_cast<double>(form.size())) {
    const FormItem& item = form[static_cast<std::size_t>(k)];
    if (!item.is_number) return word_value(lowering, item.text);
    if (!actual) return Value{Type::real, {scaled(Lowering::expression(item.operand), to_program(item.type, lowering.units))}};
    if (auto value = actual_number(lowering, *feature, item)) return value;
    lowering.error(Code::E0245, index.span, fmt::format("argument {} ({}) of a measured {} cannot be read", index.number, item.name, def.kind->word), "read it from the nominal: F instead of FA");
    return std::nullopt;
  }
  lowering.error(Code::E0245, index.span, fmt::format("{} has {} arguments, FEAT counted as 1; there is no {}", def.kind->word, form.size() + 1, index.number),
                 fmt::format("for example: {}", def.kind->example));
  return std::nullopt;
}

std::optional<Value> from_tolerance(Lowering& lowering, const MatchedValue& label, const MatchedValue& index) {
  const ToleranceSymbol* symbol = lowering.tolerance(label.label);
  if (!symbol) return std::nullopt;
  std::vector<plan::CharacteristicId> evaluated;
  for (std::size_t c = 0; c < lowering.out.plan.characteristics.size(); ++c) {
    const plan::CharacteristicId id{static_cast<int>(c)};
    if (upper(lowering.out.plan[lowering.out.plan[id].tolerance].label) == upper(label.label.name)) evaluated.push_back(id);
  }
  if (evaluated.empty()) {
    lowering.error(Code::E0245, label.span, fmt::format("TA({}) is not evaluated above", label.label.name), "evaluate it first: OUTPUT/FA(feature),TA(tolerance) or EVAL");
    return std::nullopt;
  }
  const Arguments& arguments = lowering.out.plan[lowering.out.plan[evaluated.back()].tolerance].arguments;
  const auto read = [&](bool status) {
    const plan::ColumnId column{lowering.out.plan.columns++};
    lowering.emit(plan::ObtainEvaluation{column, evaluated, status});
    return plan::Expression{plan::PushColumn{column}};
  };
  const bool distance = symbol->kind->word.starts_with("DIST");
  const std::string qualifier = arguments.text("axis", arguments.text("space"));
  std::vector<std::string> form = {"TOL", std::string(symbol->kind->word)};
  if (distance)
    form.insert(form.end(), {"status", "NOMINL", "value", qualifier});
  else {
    if (!qualifier.empty()) form.push_back(qualifier);
    form.insert(form.end(), {"value", "status"});
  }
  if (index.number < 1 || index.number > static_cast<double>(form.size())) {
    lowering.error(Code::E0245, index.span, fmt::format("TA({}) has {} arguments, TOL counted as 1; there is no {}", label.label.name, form.size(), index.number),
                   "in the result file it is TOL/" + std::string(symbol->kind->word) + ",...,value,INTOL");
    return std::nullopt;
  }
  const std::string& item = form[static_cast<std::size_t>(index.number) - 1];
  const ValueType type = unit_of(*symbol->kind, arguments) == Unit::rad ? ValueType::angle : ValueType::length;
  if (item == "value") return Value{Type::real, {scaled(read(false), to_program(type, lowering.units))}};
  if (item != "status") return word_value(lowering, item);
  const double in = lowering.texts.value("INTOL").constant(), out = lowering.texts.value("OUTOL").constant();
  return Value{Type::text, {combine(Op2::add, scaled(read(true), in - out), {plan::PushConstant{out}})}};
}

void obtain(Lowering& lowering, const RawStatement& raw, const Match& match) {
  const MatchedValue& what = match.values[0];
  const auto value = what.type == ValueType::feature ? from_feature(lowering, what, *match.find("index")) : from_tolerance(lowering, what, *match.find("index"));
  if (value) assign_to_label(lowering, raw, *value);
}

}  // namespace

extern const Statement kObtain;
const Statement kObtain = {"OBTAIN",
                           "=",
                           "( feature:feature ; tolerance:tolerance ), index:integer",
                           "Reads argument number index of a feature, FEAT counted as 1: of F(l) as defined, of FA(l) as measured, in the current coordinate system; or of "
                           "an evaluated tolerance TA(t), TOL counted as 1: value and INTOL or OUTOL as in the result file.",
                           "X=OBTAIN/FA(P1),4",
                           "ISO 22093, OBTAIN",
                           obtain};

}  // namespace abbe::lang
