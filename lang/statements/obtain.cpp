// OBTAIN: what a feature, tolerance or sensor is, argument by argument.
//
// Arguments are counted as the statement has them, its word being the first: in
// FA(P)=FEAT/POINT,CART,x,y,z,i,j,k the x is number 4. F, T and S are what the program defined. FA is the
// feature as measured, in the form of its FEAT statement and the current coordinate system. TA is the
// evaluated tolerance in the form of the result file: TA(T)=TOL/DIAM,value,INTOL.
#include <fmt/format.h>

#include <array>

#include "lang/statement.hpp"
#include "lang/statements/target.hpp"

namespace abbe::lang {

namespace {

using plan::Op1, plan::Op2;
using Form = std::vector<FormItem>;

/// What of a measured element an argument is: a quantity, times a factor.
struct Reading {
  plan::Quantity quantity{};
  double times = 1;
};

const FormItem* item_of(const Form& form, std::string_view name) {
  for (const FormItem& item : form)
    if (item.name == name) return &item;
  return nullptr;
}

/// Three constants of the form that are named by letters and a suffix: "x1", "y1", "z1".
Vec3 given(const Form& form, std::string_view letters, std::string_view suffix) {
  Vec3 v;
  for (int k = 0; k < 3; ++k)
    if (const FormItem* item = item_of(form, fmt::format("{}{}", letters[k], suffix))) v[k] = item->operand.constant;
  return v;
}

double sign_of(double v) { return v < 0 ? -1 : 1; }

/// The first component of the point that FEAT has of the shape, as the result file gives it (FeatureKind::written).
plan::Quantity place_of(Shape shape) {
  return shape == Shape::cone    ? plan::Quantity::apex_x
      : shape == Shape::cylinder ? plan::Quantity::begin_x
                                 : plan::Quantity::x;
}

plan::Quantity component(plan::Quantity first, int k) {
  return static_cast<plan::Quantity>(static_cast<int>(first) + k);
}

/// The first component of the vector named by a letter (x for places, i for directions) and a suffix.
std::optional<Reading> vector_reading(const plan::FeatureDef& def, const Form& form, char letter,
                                      std::string_view suffix) {
  const Shape shape = def.kind->shape;
  const Element& nominal = def.nominal;
  const bool place = letter == 'x', faces = shape == Shape::parallel_planes;
  if (suffix.empty()) return Reading{place ? place_of(shape) : plan::Quantity::i};
  if (suffix == "s" || suffix == "n") return Reading{plan::Quantity::second_i};
  const bool first = suffix == "1";
  if (place && shape == Shape::line) return Reading{first ? plan::Quantity::begin_x : plan::Quantity::end_x};
  if (place && shape == Shape::ellipse) return Reading{first ? plan::Quantity::focus1_x : plan::Quantity::focus2_x};
  if (place && faces)
    return Reading{dot(given(form, "xyz", suffix) - nominal.point, nominal.direction) > 0 ? plan::Quantity::face1_x
                                                                                          : plan::Quantity::face2_x};
  if (faces) return Reading{plan::Quantity::i, sign_of(dot(given(form, "ijk", suffix), nominal.direction))};
  if (shape == Shape::slot || (shape == Shape::rectangle && first)) return Reading{plan::Quantity::second_i};
  if (shape == Shape::rectangle && suffix == "2")
    return Reading{plan::Quantity::third_i,
                   sign_of(dot(given(form, "ijk", "2"), cross(nominal.direction, nominal.second)))};
  return shape == Shape::rectangle ? std::optional(Reading{plan::Quantity::i}) : std::nullopt;
}

/// Sizes and angles.
std::optional<Reading> size_reading(const plan::FeatureDef& def, const Form& form, std::string_view name) {
  const Shape shape = def.kind->shape;
  if (name == "diam") {
    const FormItem* axis = item_of(form, "axis");
    return Reading{axis && axis->text == "MINOR" ? plan::Quantity::minor_radius : plan::Quantity::radius, 2};
  }
  if (name == "radius") return Reading{plan::Quantity::radius};
  if (name == "majdia" || name == "len1") return Reading{plan::Quantity::radius, 2};
  if (name == "mindia" || name == "len2") return Reading{plan::Quantity::minor_radius, 2};
  if (name == "width") return Reading{shape == Shape::slot ? plan::Quantity::minor_radius : plan::Quantity::radius, 2};
  if (name == "length")
    return shape == Shape::slot ? Reading{plan::Quantity::radius, 2} : Reading{plan::Quantity::length};
  if (name == "len3") return Reading{plan::Quantity::length};
  if (name == "angle") return Reading{plan::Quantity::angle, 2};
  return name == "sweep" ? std::optional(Reading{plan::Quantity::angle}) : std::nullopt;
}

/// "y2" to the second component of the vector x2; "nj" and "js" are components of the vector that turns the feature.
std::optional<Reading> reading_of(const plan::FeatureDef& def, const Form& form, std::string_view name) {
  const bool prefixed = name.size() == 2 && name[0] == 'n';
  const char letter = prefixed ? name[1] : name[0];
  const std::string_view suffix = prefixed ? name.substr(0, 1) : name.substr(1);
  for (const std::string_view letters : {"xyz", "ijk"}) {
    const std::size_t k = letters.find(letter);
    if (k == std::string_view::npos || suffix.size() > 1) continue;
    std::optional<Reading> reading = vector_reading(def, form, letters[0], suffix);
    if (reading) reading->quantity = component(reading->quantity, static_cast<int>(k));
    return reading;
  }
  return name == "h" ? Reading{component(place_of(def.kind->shape), 2)} : size_reading(def, form, name);
}

/// Whether the nominal decides what an argument means: which of two faces, and the sense of the second side of a block.
bool nominal_decides(Shape shape, std::string_view name) {
  if (name.size() != 2) return false;
  return shape == Shape::parallel_planes ? name[1] == '1' || name[1] == '2'
                                         : shape == Shape::rectangle && name[1] == '2';
}

plan::Expression obtained(Lowering& lowering, plan::FeatureId feature, plan::Quantity quantity) {
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

/// An argument as the program wrote it.
Value written(Lowering& lowering, const FormItem& item) {
  if (!item.is_number) return word_value(lowering, item.text);
  return Value{Type::real, {scaled(Lowering::expression(item.operand), to_program(item.type, lowering.units))}};
}

/// The argument that an index names, the word of the statement being the first; nothing after an error.
const FormItem* indexed(Lowering& lowering, const Form& form, const MatchedValue& index, std::string_view what,
                        std::string_view word, std::string_view example) {
  static const FormItem words[] = {
      {"FEAT", "", false, {}, {}}, {"TOL", "", false, {}, {}}, {"SNSDEF", "", false, {}, {}}};
  if (index.number == 1)
    for (const FormItem& item : words)
      if (item.text == word) return &item;
  const double k = index.number - 2;
  if (k >= 0 && k < static_cast<double>(form.size())) return &form[static_cast<std::size_t>(k)];
  lowering.error(
      Code::E0245, index.span,
      fmt::format("{} has {} arguments, {} counted as 1; there is no {}", what, form.size() + 1, word, index.number),
      fmt::format("for example: {}", example));
  return nullptr;
}

std::optional<Value> from_feature(Lowering& lowering, const MatchedValue& label, const MatchedValue& index) {
  const bool actual = label.label.kind == "FA";
  const auto feature = actual ? lowering.actual_feature(label.label) : lowering.defined_feature(label.label);
  if (!feature) return std::nullopt;
  const plan::FeatureDef& def = lowering.out.plan[*feature];
  const Form& form = lowering.forms[feature->value];
  const FormItem* item = indexed(lowering, form, index, def.kind->word, "FEAT", def.kind->example);
  if (!item) return std::nullopt;
  // Where an arc starts is not measured.
  if (!actual || !item->is_number || item->name == "start") return written(lowering, *item);
  const double unit = to_program(item->type, lowering.units);
  if (item->name == "r" || item->name == "a") {
    const plan::Quantity place = place_of(def.kind->shape);
    const plan::Expression x = obtained(lowering, *feature, place),
                           y = obtained(lowering, *feature, component(place, 1));
    const plan::Expression squares = combine(Op2::add, combine(Op2::multiply, x, x), combine(Op2::multiply, y, y));
    return Value{Type::real,
                 {scaled(item->name == "r" ? combine(Op1::sqrt, squares) : combine(Op2::atan2, y, x), unit)}};
  }
  if (!def.varying.empty() && nominal_decides(def.kind->shape, item->name)) {
    lowering.error(
        Code::E0231, label.span,
        fmt::format("what argument {} of FA({}) is, the nominal decides, and that depends on a measured value",
                    index.number, label.label.name),
        "give its FEAT numbers, or variables that nothing measured goes into");
    return std::nullopt;
  }
  const std::optional<Reading> reading = reading_of(def, form, item->name);
  ABBE_CHECK(reading);
  return Value{Type::real, {scaled(obtained(lowering, *feature, reading->quantity), reading->times * unit)}};
}

/// TA in the form of the result file.
std::vector<std::string> result_form(const ToleranceKind& kind, const Arguments& arguments) {
  const std::string qualifier = arguments.text("axis", arguments.text("space"));
  std::vector<std::string> form = {"TOL", std::string(kind.word)};
  if (kind.word.starts_with("DIST")) {
    form.insert(form.end(), {"status", "NOMINL", "value", qualifier});
  } else {
    if (!qualifier.empty()) form.push_back(qualifier);
    form.insert(form.end(), {"value", "status"});
  }
  return form;
}

std::optional<Value> from_evaluation(Lowering& lowering, const ToleranceSymbol& symbol, const MatchedValue& label,
                                     const MatchedValue& index) {
  std::vector<plan::CharacteristicId> evaluated;
  for (std::size_t c = 0; c < lowering.out.plan.characteristics.size(); ++c) {
    const plan::CharacteristicId id{static_cast<int>(c)};
    if (upper(lowering.out.plan[lowering.out.plan[id].tolerance].label) == upper(label.label.name))
      evaluated.push_back(id);
  }
  if (evaluated.empty()) {
    lowering.error(Code::E0245, label.span, fmt::format("TA({}) is not evaluated above", label.label.name),
                   "evaluate it first: OUTPUT/FA(feature),TA(tolerance) or EVAL");
    return std::nullopt;
  }
  const Arguments& arguments = lowering.out.plan[lowering.out.plan[evaluated.back()].tolerance].arguments;
  const auto read = [&](bool status) {
    const plan::ColumnId column{lowering.out.plan.columns++};
    lowering.emit(plan::ObtainEvaluation{column, evaluated, status});
    return plan::Expression{plan::PushColumn{column}};
  };
  const std::vector<std::string> form = result_form(*symbol.kind, arguments);
  if (index.number < 1 || index.number > static_cast<double>(form.size())) {
    lowering.error(Code::E0245, index.span,
                   fmt::format("TA({}) has {} arguments, TOL counted as 1; there is no {}", label.label.name,
                               form.size(), index.number),
                   "in the result file it is TOL/" + std::string(symbol.kind->word) + ",...,value,INTOL");
    return std::nullopt;
  }
  const std::string& item = form[static_cast<std::size_t>(index.number) - 1];
  const ValueType type = unit_of(*symbol.kind, arguments) == Unit::rad ? ValueType::angle : ValueType::length;
  if (item == "value") return Value{Type::real, {scaled(read(false), to_program(type, lowering.units))}};
  if (item != "status") return word_value(lowering, item);
  const double in = lowering.texts.value("INTOL").constant(), out = lowering.texts.value("OUTOL").constant();
  return Value{Type::text, {combine(Op2::add, scaled(read(true), in - out), {plan::PushConstant{out}})}};
}

std::optional<Value> from_tolerance(Lowering& lowering, const MatchedValue& label, const MatchedValue& index) {
  const ToleranceSymbol* symbol = lowering.tolerance(label.label);
  if (!symbol) return std::nullopt;
  if (label.label.kind == "TA") return from_evaluation(lowering, *symbol, label, index);
  const FormItem* item =
      indexed(lowering, symbol->form, index, fmt::format("T({})", label.label.name), "TOL", symbol->kind->example);
  return item ? std::optional(written(lowering, *item)) : std::nullopt;
}

std::optional<Value> from_sensor(Lowering& lowering, const MatchedValue& label, const MatchedValue& index) {
  const auto sensor = lowering.sensor(label.label);
  if (!sensor) return std::nullopt;
  const auto form = lowering.sensor_forms.find(sensor->value);
  if (form == lowering.sensor_forms.end()) {
    lowering.error(
        Code::E0245, label.span,
        fmt::format("{}({}) is described by the machine file, not by the program", label.label.kind, label.label.name),
        "define it with SNSDEF to read its numbers");
    return std::nullopt;
  }
  const FormItem* item = indexed(lowering, form->second, index, fmt::format("S({})", label.label.name), "SNSDEF",
                                 "S(P1)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,100,4");
  return item ? std::optional(written(lowering, *item)) : std::nullopt;
}

void obtain(Lowering& lowering, const RawStatement& raw, const Match& match) {
  const MatchedValue& what = match.values[0];
  const auto from = what.type == ValueType::feature ? from_feature
      : what.type == ValueType::sensor              ? from_sensor
                                                    : from_tolerance;
  const std::optional<Value> value = from(lowering, what, *match.find("index"));
  if (value) assign_to_label(lowering, raw, *value);
}

}  // namespace

extern const Statement kObtain;
const Statement kObtain = {
    .word = "OBTAIN",
    .label = "=",
    .signature = "( feature:feature ; tolerance:tolerance ; sensor:sensor ), index:integer",
    .help =
        "Reads argument number index of a statement, its word counted as 1: of F(l), T(l) or S(l) as defined; of FA(l) as the result file has it, "
        "measured, in the current coordinate system; of an evaluated tolerance TA(l) value and INTOL or OUTOL as in the result file.",
    .example = "X=OBTAIN/FA(BORE),5",
    .source = "ISO 22093, OBTAIN",
    .lower = obtain,
};

}  // namespace abbe::lang
