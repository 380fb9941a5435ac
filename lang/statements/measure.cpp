// A measurement: MEAS, PTMEAS, ENDMES.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/features/pattern.hpp"
#include "lang/statement.hpp"
#include "lang/statements/words.hpp"

namespace abbe::lang {

namespace {

/// The block ends here, whether by ENDMES or because the program forgot it.
void close_block(Lowering& lowering) {
  OpenMeasure block = *std::exchange(lowering.measuring, std::nullopt);
  if (block.spoilt.empty()) block.spoilt = lowering.doubt();
  auto& operations = lowering.out.plan.operations;
  if (block.spoilt.empty()) {
    const auto criterion = lowering.criteria.find(lowering.out.plan[block.feature].kind->shape);
    lowering.emit(plan::EndMeasure{block.feature, criterion == lowering.criteria.end()
                                                      ? FitCriterion::least_squares
                                                      : criterion->second});
    lowering.actual(block.feature) = {true, ""};
    return;
  }
  // Moves stay: the next block relies on where the tip is.
  const auto begin = operations.begin() + static_cast<std::ptrdiff_t>(block.first_operation);
  for (auto o = begin; o != operations.end(); ++o)
    if (std::holds_alternative<plan::BeginMeasure>(o->action) || std::holds_alternative<plan::Touch>(o->action))
      o->action = plan::Jump{kDropped};
  if (block.feature.valid()) lowering.actual(block.feature) = {false, block.spoilt};
}

void begin_measure(Lowering& lowering, const RawStatement& raw, const Match& match) {
  if (lowering.measuring) {
    const int line = lowering.measuring->line;
    lowering.measuring->spoilt = fmt::format("its MEAS in line {} has no ENDMES", line);
    close_block(lowering);
    lowering.error(Code::E0205, raw.word_span,
                   fmt::format("the MEAS of line {} has no ENDMES", line),
                   "end it before the next MEAS");
  }
  OpenMeasure block;
  block.span = raw.span;
  block.line = raw.line;
  block.declared = static_cast<int>(match.number("count"));
  block.count_span = match.find("count")->span;
  block.first_operation = lowering.out.plan.operations.size();
  if (const auto feature = lowering.defined_feature(match.find("feature")->label)) {
    block.feature = *feature;
    check_kind(lowering, *match.find("kind"), *feature);
    lowering.emit(plan::BeginMeasure{*feature});
  }
  if (lowering.failed) block.spoilt = lowering.blame();
  lowering.measuring = block;
}

void touch(Lowering& lowering, const RawStatement& raw, const Match& match) {
  if (!lowering.measuring)
    return lowering.error(Code::E0204, raw.word_span, "PTMEAS outside MEAS..ENDMES",
                          "put it between MEAS/kind,F(name),count and ENDMES");
  OpenMeasure& block = *lowering.measuring;
  ++block.touches;
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
  if (block.feature.valid() && !lowering.failed) lowering.emit(operation);
}

/// A block without PTMEAS: the machine chooses the points (engine/features/pattern.hpp).
void measure_by_pattern(Lowering& lowering, const OpenMeasure& block) {
  const FeatureKind& kind = *lowering.out.plan[block.feature].kind;
  const auto& modes = lowering.modes;
  if (!modes.empty() && std::find(modes.begin(), modes.end(), "AUTO") == modes.end())
    return lowering.error(Code::E0203, block.span, "this MEAS has no PTMEAS, and MODE does not let the machine choose",
                          "give the points with PTMEAS, or write MODE/AUTO,PROG,MAN before it");
  if (pattern_help(kind.shape).empty())
    return lowering.error(Code::E0203, block.span, fmt::format("this MEAS has no PTMEAS, and a {} has no default points", kind.word),
                          "give the points with PTMEAS between MEAS and ENDMES");
  if (!lowering.sensor_selected && lowering.sensor_doubt.empty())
    return lowering.error(Code::E0207, block.span, "missing sensor: no sensor is selected here",
                          "select one with SNSLCT/S(name) before measuring");
  const int fewest = pattern_minimum(kind.shape);
  if (block.declared < fewest || block.declared > kMostPatternTouches)
    return lowering.error(block.declared < fewest ? Code::E0211 : Code::E0251, block.count_span,
                          fmt::format("{} default touches, but a {} takes {} to {}", block.declared, kind.word, fewest,
                                      kMostPatternTouches),
                          "change the number in MEAS");
  for (int k = 0; k < block.declared; ++k) {
    plan::Touch touch{block.feature, {}, {}, false};
    touch.pattern_index = k, touch.pattern_count = block.declared;
    lowering.emit(touch);
  }
}

void end_measure(Lowering& lowering, const RawStatement& raw, const Match&) {
  if (!lowering.measuring)
    return lowering.error(Code::E0206, raw.word_span, "ENDMES without a MEAS",
                          "remove it, or write the MEAS that it should end");
  OpenMeasure& block = *lowering.measuring;
  if (block.feature.valid() && block.spoilt.empty() && (!block.varies || block.touches == 0)) {
    const FeatureKind& kind = *lowering.out.plan[block.feature].kind;
    if (block.touches == 0) {
      measure_by_pattern(lowering, block);
    } else if (block.touches < kind.minimum_points) {
      lowering.error(Code::E0211, block.span,
                     fmt::format("{} touches, but a {} needs at least {}", block.touches, kind.word,
                                 kind.minimum_points),
                     "add PTMEAS statements");
    } else if (block.touches != block.declared) {
      lowering.warn(
          Code::W0221, block.count_span,
          fmt::format("{} touches announced, {} PTMEAS given", block.declared, block.touches),
          "the touches given are measured", std::to_string(block.touches));
    }
    if (lowering.failed) block.spoilt = lowering.blame();
  }
  close_block(lowering);
}

}  // namespace

extern const Statement kMeas, kPtmeas, kEndmes;

const Statement kMeas = {"MEAS",
                         "",
                         "kind:word, feature:feature, count:integer",
                         "Begins the measurement of a feature with this many touches; PTMEAS and "
                         "GOTO follow, up to ENDMES. Without PTMEAS the machine touches it at its "
                         "default points.",
                         "MEAS/CIRCLE,F(BORE),4",
                         "ISO 22093, MEAS",
                         begin_measure};
const Statement kPtmeas = {"PTMEAS",
                           "",
                           "( CART, x:length, y:length, z:length ; POL, r:length, a:angle, "
                           "h:length ), [ i:number, j:number, k:number ]",
                           "Touches the surface at a point; i,j,k points out of the material and "
                           "the machine travels against it. Without a "
                           "vector the nominal feature supplies it.",
                           "PTMEAS/CART,10,20,0,0,0,1",
                           "ISO 22093, PTMEAS",
                           touch,
                           Varying::taken};
const Statement kEndmes = {"ENDMES",   "",
                           "",         "Ends a measurement and fits the feature to its touches.",
                           "ENDMES",   "ISO 22093, ENDMES",
                           end_measure};

}  // namespace abbe::lang
