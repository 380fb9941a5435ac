// A measurement: MEAS, RMEAS or CALIB, then PTMEAS, up to ENDMES.
//
// RMEAS moves its touches by what a feature measured before lies beside its nominal: the machine goes where
// the part is, not where the drawing has it. The true surface moves with the error-free machine, so what is
// left of it on a virtual machine is the error of the earlier feature.
//
// CALIB qualifies a sensor on a sphere. A virtual machine's sensors are qualified already: what qualification
// leaves of errors is said by its machine file (head, probe and their effects). So the touches are made, take
// their time and give FA(sphere), and the sensor stays as it is.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/features/pattern.hpp"
#include "lang/statement.hpp"
#include "lang/statements/words.hpp"

namespace abbe::lang {

namespace {

constexpr double kMostTouches = 1e6;  ///< that a block announces

/// What holds where a touch is made and where the feature is fitted decides whether the measurement can be relied on.
void doubt_what_is_measured(Lowering& lowering) {
  OpenMeasure& block = *lowering.measuring;
  if (block.spoilt.empty()) block.spoilt = lowering.measuring_doubt();
}

/// The block ends here, whether by ENDMES or because the program forgot it.
void close_block(Lowering& lowering) {
  doubt_what_is_measured(lowering);
  OpenMeasure block = *std::exchange(lowering.measuring, std::nullopt);
  auto& operations = lowering.out.plan.operations;
  const FitCriterion* criterion = nullptr;
  if (block.spoilt.empty()) {
    const FeatureKind& kind = *lowering.out.plan[block.feature].kind;
    criterion = lowering.use(lowering.criteria[kind.shape], fmt::format("GEOALG/{}", kind.word), block.span);
    if (!criterion) block.spoilt = lowering.blame();
  }
  if (criterion) {
    lowering.emit(plan::EndMeasure{block.feature, *criterion});
    lowering.actuals.set(block.feature.value, {true, ""});
    return;
  }
  // Moves stay: the next block relies on where the tip is.
  const auto begin = operations.begin() + static_cast<std::ptrdiff_t>(block.first_operation);
  for (auto o = begin; o != operations.end(); ++o)
    if (std::holds_alternative<plan::BeginMeasure>(o->action) || std::holds_alternative<plan::Touch>(o->action))
      o->action = plan::Jump{kDropped};
  if (block.feature.valid()) lowering.actuals.set(block.feature.value, {false, block.spoilt});
}

void open_block(Lowering& lowering, const RawStatement& raw, const Match& match) {
  if (lowering.measuring) {
    const int line = lowering.measuring->line;
    lowering.measuring->spoilt = fmt::format("its MEAS in line {} has no ENDMES", line);
    close_block(lowering);
    lowering.error(Code::E0205, raw.word_span, fmt::format("the MEAS of line {} has no ENDMES", line),
                   "end it before the next MEAS");
  }
  OpenMeasure block;
  block.span = raw.span;
  block.place = lowering.here().first;
  block.line = raw.line;
  block.count_span = match.find("count")->span;
  if (const double count = match.number("count"); count >= 0 && count <= kMostTouches)
    block.declared = static_cast<int>(count);
  else
    lowering.error(Code::E0106, block.count_span,
                   fmt::format("{:g} touches: {} takes 0 to {}", count, raw.word, kMostTouches),
                   "give the number of touches in the block");
  block.first_operation = lowering.out.plan.operations.size();
  if (const auto feature = lowering.defined_feature(match.find("feature")->label)) {
    block.feature = *feature;
    if (const MatchedValue* kind = match.find("kind")) check_kind(lowering, *kind, *feature);
    lowering.emit(plan::BeginMeasure{*feature});
  }
  if (lowering.failed) block.spoilt = lowering.blame();
  lowering.measuring = block;
}

void begin_measure(Lowering& lowering, const RawStatement& raw, const Match& match) {
  open_block(lowering, raw, match);
}

/// The displacement of FA(f), or the part of it along an axis; nothing for F(f), the nominal itself.
std::optional<plan::Point> displacement_of(Lowering& lowering, const Match& match) {
  const MatchedValue& reference = *match.find("reference");
  if (reference.label.kind != "FA") {
    lowering.defined_feature(reference.label);
    return std::nullopt;
  }
  const auto feature = lowering.actual_feature(reference.label);
  if (!feature) return std::nullopt;
  const plan::ColumnId first{lowering.out.plan.columns};
  lowering.out.plan.columns += 3;
  lowering.emit(plan::ObtainDisplacement{first, *feature});
  const std::string axis = match.text("axis");
  plan::Point by;
  for (int k = 0; k < 3; ++k)
    if (axis.empty() || static_cast<int>(axis_of(axis)) == k) by[k].column = plan::ColumnId{first.value + k};
  return by;
}

void begin_relative(Lowering& lowering, const RawStatement& raw, const Match& match) {
  std::optional<plan::Point> displaced;
  if (match.has("reference")) {
    displaced = displacement_of(lowering, match);
  } else {
    lowering.warn(Code::W0255, match.find("radius")->span,
                  "the touches that only look for the direction of the surface are left out",
                  "the machine drives along the vectors of PTMEAS");
  }
  const bool known = !lowering.failed;
  open_block(lowering, raw, match);
  lowering.measuring->displaced = displaced;
  if (!known) lowering.measuring->spoilt = lowering.blame();
}

void begin_calibration(Lowering& lowering, const RawStatement& raw, const Match& match) {
  if (const MatchedValue* sensor = match.find("sensor")) {
    if (sensor->label.kind == "SA") lowering.sensor_of_machine_file(sensor->label);
    const auto id = lowering.sensor(sensor->label);
    if (id) lowering.emit(plan::SelectSensor{*id});
    lowering.sensor_selected |= id.has_value();
  }
  open_block(lowering, raw, match);
}

plan::Point sum(Lowering& lowering, const plan::Point& a, const plan::Point& b) {
  plan::Point out;
  for (int k = 0; k < 3; ++k)
    out[k] = lowering.operand(combine(plan::Op2::add, Lowering::expression(a[k]), Lowering::expression(b[k])));
  return out;
}

void touch(Lowering& lowering, const RawStatement& raw, const Match& match) {
  if (!lowering.measuring)
    return lowering.error(Code::E0204, raw.word_span, "PTMEAS outside MEAS..ENDMES",
                          "put it between MEAS/kind,F(name),count and ENDMES");
  OpenMeasure& block = *lowering.measuring;
  ++block.touches;
  doubt_what_is_measured(lowering);
  if (!lowering.sensor_selected && lowering.sensor_doubt.empty() && block.touches == 1)
    lowering.error(Code::E0207, raw.word_span, "missing sensor: no sensor is selected here",
                   "select one with SNSLCT/S(name) before measuring");
  plan::Touch operation{block.feature, {}, {}, match.has("i")};
  if (match.has("x")) {
    operation.point = Lowering::point(match, "x");
  } else {
    operation.point = lowering.polar(match);
  }
  if (operation.has_normal && is_varying(match, "i")) {
    operation.normal = Lowering::point(match, "i");
  } else if (operation.has_normal) {
    const std::optional<Vec3> n = direction_vector(lowering, match, "i");
    if (!n) return;
    operation.normal = {plan::Operand{n->x, {}}, plan::Operand{n->y, {}}, plan::Operand{n->z, {}}};
  }
  if (block.displaced) operation.point = sum(lowering, operation.point, *block.displaced);
  if (block.feature.valid() && !lowering.failed) lowering.emit(operation);
}

/// A block without PTMEAS: the machine chooses the points (engine/features/pattern.hpp).
void measure_by_pattern(Lowering& lowering, const OpenMeasure& block) {
  const FeatureKind& kind = *lowering.out.plan[block.feature].kind;
  const bool* machine_chooses = lowering.use(lowering.machine_chooses, "MODE", block.span);
  if (!machine_chooses) return;
  if (!*machine_chooses)
    return lowering.error(Code::E0203, block.span, "this MEAS has no PTMEAS, and MODE does not let the machine choose",
                          "give the points with PTMEAS, or write MODE/AUTO,PROG,MAN before it");
  if (!kind.pattern.touch)
    return lowering.error(Code::E0203, block.span,
                          fmt::format("this MEAS has no PTMEAS, and a {} has no default points", kind.word),
                          "give the points with PTMEAS between MEAS and ENDMES");
  if (!lowering.sensor_selected && lowering.sensor_doubt.empty())
    return lowering.error(Code::E0207, block.span, "missing sensor: no sensor is selected here",
                          "select one with SNSLCT/S(name) before measuring");
  const int fewest = pattern_minimum(kind);
  if (block.declared < fewest || block.declared > kMostPatternTouches)
    return lowering.error(block.declared < fewest ? Code::E0211 : Code::E0251, block.count_span,
                          fmt::format("{} default touches, but a {} takes {} to {}", block.declared, kind.word, fewest,
                                      kMostPatternTouches),
                          "change the number in MEAS");
  for (int k = 0; k < block.declared; ++k) {
    plan::Touch touch{block.feature, {}, {}, false};
    touch.pattern_index = k, touch.pattern_count = block.declared;
    if (block.displaced) touch.point = *block.displaced;
    lowering.emit(touch);
    lowering.out.plan.operations.back().span = block.place;  // the MEAS asks for it, not the ENDMES
  }
}

void warn_of_scan(Lowering& lowering, const OpenMeasure& block) {
  lowering.warn(
      Code::W0261, block.scan->first,
      fmt::format("{} default touches stand for this scan, which is not supported yet", block.declared),
      "the feature is touched at its default points, not along the path; give PTMEAS, or leave out what needs it with --only-valid");
}

void end_measure(Lowering& lowering, const RawStatement& raw, const Match&) {
  if (!lowering.measuring)
    return lowering.error(Code::E0206, raw.word_span, "ENDMES without a MEAS",
                          "remove it, or write the MEAS that it should end");
  OpenMeasure& block = *lowering.measuring;
  if (block.feature.valid() && block.spoilt.empty() && (!block.varies || block.touches == 0)) {
    const FeatureKind& kind = *lowering.out.plan[block.feature].kind;
    if (block.touches == 0 && block.scan && lowering.only_valid) {
      block.spoilt = fmt::format("line {}: its scan is not supported yet", block.scan->second);
    } else if (block.touches == 0) {
      measure_by_pattern(lowering, block);
      if (block.scan && !lowering.failed) warn_of_scan(lowering, block);
    } else if (block.touches < kind.minimum_points) {
      lowering.error(
          Code::E0211, block.span,
          fmt::format("{} touches, but a {} needs at least {}", block.touches, kind.word, kind.minimum_points),
          "add PTMEAS statements");
    } else if (block.touches != block.declared) {
      lowering.warn(Code::W0221, block.count_span,
                    fmt::format("{} touches announced, {} PTMEAS given", block.declared, block.touches),
                    "the touches given are measured", std::to_string(block.touches));
    }
    if (lowering.failed) block.spoilt = lowering.blame();
  }
  close_block(lowering);
}

}  // namespace

extern const Statement kMeas, kRmeas, kCalib, kPtmeas, kEndmes;

const Statement kMeas = {
    .word = "MEAS",
    .signature = "kind:word, feature:feature, count:integer",
    .help =
        "Begins the measurement of a feature with this many touches; PTMEAS and "
        "GOTO follow, up to ENDMES. Without PTMEAS the machine touches it at its "
        "default points.",
    .example = "MEAS/CIRCLE,F(BORE),4",
    .source = "ISO 22093, MEAS",
    .lower = begin_measure,
    .doubt = Doubt::measurement,
};
const Statement kRmeas = {
    .word = "RMEAS",
    .signature =
        "kind:word, feature:feature, count:integer, ( VECBLD, radius:length, touches:integer ; "
        "reference:feature, [ axis:XAXIS|YAXIS|ZAXIS ] )",
    .help =
        "Begins a measurement as MEAS does, relative to a feature measured before: every touch is "
        "displaced by what FA(reference) lies beside its nominal, or by the part of that along an axis. "
        "VECBLD, which looks for the direction of the surface first, measures along the vectors of "
        "PTMEAS, with a warning.",
    .example = "RMEAS/CIRCLE,F(BORE),4,FA(FACE)",
    .source = "ISO 22093, RMEAS",
    .lower = begin_relative,
    .doubt = Doubt::measurement,
};
const Statement kCalib = {
    .word = "CALIB",
    .signature = "( SENS, sensor:sensor, feature:feature, count:integer ; MASTER, feature:feature, count:integer )",
    .help =
        "Qualifies a sensor on a sphere; PTMEAS follow, up to ENDMES. The touches are made and FA(sphere) "
        "is measured. The sensor stays as the machine file describes it: what a qualification leaves of "
        "errors is part of the machine, by the effects of its head and probe.",
    .example = "CALIB/SENS,S(P1),F(BALL),25",
    .source = "ISO 22093, CALIB",
    .lower = begin_calibration,
    .doubt = Doubt::measurement,
};
const Statement kPtmeas = {
    .word = "PTMEAS",
    .signature =
        "( CART, x:length, y:length, z:length ; POL, r:length, a:angle, "
        "h:length ), [ i:number, j:number, k:number ]",
    .help =
        "Touches the surface at a point; i,j,k points out of the material and "
        "the machine travels against it. Without a "
        "vector the nominal feature supplies it.",
    .example = "PTMEAS/CART,10,20,0,0,0,1",
    .source = "ISO 22093, PTMEAS",
    .lower = touch,
    .varying = Varying::taken,
};
const Statement kEndmes = {
    .word = "ENDMES",
    .help = "Ends a measurement and fits the feature to its touches.",
    .example = "ENDMES",
    .source = "ISO 22093, ENDMES",
    .lower = end_measure,
};

}  // namespace abbe::lang
