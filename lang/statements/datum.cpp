// Datums and coordinate systems: DATDEF, DATSET, TRANS, ROTATE, SAVE, RECALL.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lang/statement.hpp"
#include "lang/statements/words.hpp"

namespace abbe::lang {

namespace {

void bind_datum(Lowering& lowering, const RawStatement&, const Match& match) {
  const MatchedValue& datum = *match.find("datum");
  if (datum.label.kind != "DAT")
    return lowering.error(Code::E0106, datum.span, "DATDEF gives a feature the name of a datum, and this is a feature",
                          fmt::format("write DATDEF/FA({}),DAT(name)", match.text("feature")));
  const std::optional<plan::FeatureId> id = lowering.feature(match.find("feature")->label);
  if (id) lowering.symbols.datums.set(upper(datum.text), *id);
}

/// The words that follow the last datum: at most one direction, any origins.
void use_datum(Lowering& lowering, std::vector<plan::DatumRef>& datums, const MatchedValue& word) {
  plan::DatumRef& datum = datums.back();
  if (word.text.ends_with("ORIG")) {
    datum.origin[static_cast<int>(axis_of(word.text))] = true;
    return;
  }
  if (datum.gives_direction)
    return lowering.error(Code::E0108, word.span, "a datum gives one direction, and this is a second one",
                          "leave it out, or name another datum before it");
  if (std::count_if(datums.begin(), datums.end(), [](const plan::DatumRef& d) { return d.gives_direction; }) == 2)
    return lowering.warn(Code::W0266, word.span,
                         fmt::format("the directions of two datums settle all axes: {} has no effect", word.text),
                         "leave it out; the third axis is at a right angle to the two");
  datum.gives_direction = true;
  datum.direction = direction_of(word.text);
}

/// DATSET/TRMATX: nine elements by rows, each row an axis of the new system, and its origin. Files give
/// them with five decimals, so they are squared up.
void set_matrix_frame(Lowering& lowering, const RawStatement& raw, const Match& match) {
  const Vec3 x = vector_of(match, "xi"), y = vector_of(match, "yi"), z = vector_of(match, "zi");
  constexpr double kSlack = 1e-3;
  const bool square = std::fabs(norm(x) - 1) < kSlack && std::fabs(norm(y) - 1) < kSlack &&
      std::fabs(dot(x, y)) < kSlack && norm(cross(x, y) - z) < kSlack;
  if (!square)
    return lowering.error(Code::E0252, match.values[0].span, "these nine numbers are no rotation",
                          "each row is a unit vector, at right angles to the others, right-handed");
  const Vec3 first = unit(x), second = unit(perpendicular_part(y, first));
  lowering.emit(
      plan::SetMatrixFrame{lowering.new_frame(raw), {{first, second, cross(first, second)}, vector_of(match, "tx")}});
  lowering.frame_doubt.clear();
}

void set_frame(Lowering& lowering, const RawStatement& raw, const Match& match) {
  if (match.has("xi")) return set_matrix_frame(lowering, raw, match);
  if (match.values.empty()) {
    lowering.emit(plan::SetMachineFrame{lowering.new_frame(raw)});
    lowering.frame_doubt.clear();
    return;
  }
  std::vector<plan::DatumRef> datums;
  for (const MatchedValue& v : match.values) {
    if (v.type == ValueType::datum) {
      datums.push_back({lowering.datum(v.label).value_or(plan::FeatureId{}), false, {}, {}});
    } else {
      use_datum(lowering, datums, v);
    }
  }
  if (lowering.failed) return;
  lowering.emit(plan::SetDatumFrame{lowering.new_frame(raw), std::move(datums)});
}

void translate(Lowering& lowering, const RawStatement& raw, const Match& match) {
  std::vector<plan::OriginShift> shifts;
  for (std::size_t i = 0; i + 1 < match.values.size(); i += 2) {
    const MatchedValue& value = match.values[i + 1];
    plan::OriginShift shift{axis_of(match.values[i].text), {}, {}};
    if (value.type == ValueType::length) {
      shift.by = Lowering::operand(value);
    } else {
      const auto id = value.type == ValueType::feature ? lowering.feature(value.label) : lowering.datum(value.label);
      shift.from = id.value_or(plan::FeatureId{});
    }
    shifts.push_back(shift);
  }
  if (lowering.failed) return;
  lowering.emit(plan::TranslateFrame{lowering.new_frame(raw), std::move(shifts)});
}

void rotate(Lowering& lowering, const RawStatement& raw, const Match& match) {
  plan::RotateFrame operation;
  operation.axis = axis_of(match.text("axis"));
  if (const MatchedValue* angle = match.find("angle")) {
    operation.angle_rad = Lowering::operand(*angle);
  } else {
    const MatchedValue& to = match.values[1];
    const auto id = to.type == ValueType::feature ? lowering.feature(to.label) : lowering.datum(to.label);
    operation.to = id.value_or(plan::FeatureId{});
    operation.toward = direction_of(match.text("toward"));
    if (operation.toward.axis == operation.axis)
      lowering.error(
          Code::E0212, match.find("toward")->span,
          fmt::format("a rotation about {} cannot bring anything to {}", match.text("axis"), match.text("toward")),
          "name a direction across the axis");
  }
  if (lowering.failed) return;
  operation.result = lowering.new_frame(raw);
  lowering.emit(operation);
}

void save(Lowering& lowering, const RawStatement&, const Match& match) {
  const LabelRef& label = match.values[0].label;
  if (match.has("frame")) lowering.frame(label);
  if (match.has("sensor")) lowering.sensor(label);
  if (match.has("feature")) lowering.defined_feature(label);
}

void recall(Lowering& lowering, const RawStatement&, const Match& match) {
  const LabelRef& label = match.values[0].label;
  if (match.has("sensor")) {
    lowering.sensor_of_machine_file(label);
    lowering.sensor(label);
    return;
  }
  const std::string key = upper(label.name);
  if (key == "MCS" && !lowering.symbols.frames.has(key)) {
    const plan::FrameId machine{static_cast<int>(lowering.out.plan.frames.size())};
    lowering.symbols.frames.set(key, machine);
    lowering.out.plan.frames.push_back({label.name});
    lowering.emit(plan::SetMachineFrame{machine});
  } else if (const auto frame = lowering.frame(label)) {
    lowering.emit(plan::RecallFrame{*frame});
  }
  if (!lowering.failed) lowering.frame_doubt.clear();
}

}  // namespace

extern const Statement kDatdef, kDatset, kTrans, kRotate, kSave, kRecall;

const Statement kDatdef = {
    .word = "DATDEF",
    .signature = "feature:feature, datum:datum",
    .help = "Makes a measured or constructed feature a datum.",
    .example = "DATDEF/FA(TOP),DAT(A)",
    .source = "ISO 22093, DATDEF",
    .lower = bind_datum,
    .doubt = Doubt::datum,
};
const Statement kDatset = {
    .word = "DATSET",
    .label = "D",
    .signature =
        "( MCS ; TRMATX, xi:number, xj:number, xk:number, yi:number, yj:number, yk:number, zi:number, "
        "zj:number, zk:number, tx:length, ty:length, tz:length ; datum:datum, use:XDIR|YDIR|ZDIR|-XDIR|-YDIR|-ZDIR|XORIG|YORIG|ZORIG, "
        "{ ( datum:datum, use:XDIR|YDIR|ZDIR|-XDIR|-YDIR|-ZDIR|XORIG|YORIG|ZORIG ; "
        "use:XDIR|YDIR|ZDIR|-XDIR|-YDIR|-ZDIR|XORIG|YORIG|ZORIG ) } )",
    .help =
        "Sets the coordinate system: from datums, each with the axis that it directs and the origins "
        "that it fixes; from a matrix (its rows are the axes) and an origin; or the machine's own (MCS).",
    .example = "D(PART)=DATSET/DAT(A),ZDIR,ZORIG,DAT(B),XDIR,YORIG",
    .source = "ISO 22093, DATSET",
    .lower = set_frame,
    .doubt = Doubt::frame,
};
const Statement kTrans = {
    .word = "TRANS",
    .label = "D",
    .signature =
        "at:XORIG|YORIG|ZORIG, ( by:length ; from:feature ; from:datum ), "
        "{ at:XORIG|YORIG|ZORIG, ( by:length ; from:feature ; from:datum ) }",
    .help = "Moves the origin of the current coordinate system, to a feature or by a length.",
    .example = "D(PART)=TRANS/XORIG,FA(CORNER),ZORIG,-30",
    .source = "ISO 22093, TRANS",
    .lower = translate,
    .varying = Varying::taken,
    .doubt = Doubt::frame,
};
const Statement kRotate = {
    .word = "ROTATE",
    .label = "D",
    .signature =
        "axis:XAXIS|YAXIS|ZAXIS, ( angle:angle ; ( to:feature ; to:datum ), "
        "toward:XDIR|YDIR|ZDIR|-XDIR|-YDIR|-ZDIR )",
    .help =
        "Turns the current coordinate system about one of its axes, by an angle or until a feature points along a "
        "direction. A point, a sphere or a bore along the axis comes to lie in that direction from the origin.",
    .example = "D(PART)=ROTATE/ZAXIS,FA(EDGE),XDIR",
    .source = "ISO 22093, ROTATE",
    .lower = rotate,
    .varying = Varying::taken,
    .doubt = Doubt::frame,
};
const Statement kSave = {
    .word = "SAVE",
    .signature = "( frame:frame ; sensor:sensor ; feature:feature ), ...",
    .help = "Keeps a coordinate system, sensor or feature. All are kept here anyway; the label is checked.",
    .example = "SAVE/DA(PART)",
    .source = "ISO 22093, SAVE",
    .lower = save,
};
const Statement kRecall = {
    .word = "RECALL",
    .signature = "( frame:frame ; sensor:sensor ), ...",
    .help =
        "Makes a coordinate system current again, D(MCS) the machine's own; or "
        "announces a sensor of the machine file.",
    .example = "RECALL/DA(PART)",
    .source = "ISO 22093, RECALL",
    .lower = recall,
    .doubt = Doubt::recall,
};

}  // namespace abbe::lang
