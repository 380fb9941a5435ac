// The plan: a measurement program compiled once to a list of canonical CMM operations. THE CONTRACT between
// the language, which makes it, and the executor, which runs it. A plan is plain data; it knows neither DMIS
// syntax nor virtual machines.
//
// Values known when the program is compiled stand in the operations; values that exist only while a program
// runs live in *columns*, one number per lane. Operations are in program order and jumps name operations by
// index, so that lanes which part can meet again (docs/architecture.md, "Running a plan").
#pragma once

#include <array>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "engine/base/arguments.hpp"
#include "engine/base/ids.hpp"
#include "engine/base/source.hpp"
#include "engine/features/alignment.hpp"
#include "engine/features/construct.hpp"
#include "engine/features/criterion.hpp"
#include "engine/features/feature.hpp"
#include "engine/tolerances/material.hpp"
#include "engine/tolerances/tolerance.hpp"

namespace abbe::plan {

using FeatureId = Id<struct FeatureTag>;
using FrameId = Id<struct FrameTag>;
using SensorId = Id<struct SensorTag>;
using ToleranceId = Id<struct ToleranceTag>;
using CharacteristicId = Id<struct CharacteristicTag>;
using ColumnId = Id<struct ColumnTag>;

/// A number in an operation: a constant, or a column when `column` is valid.
struct Operand {
  double constant = 0;
  ColumnId column;
};
using Point = std::array<Operand, 3>;
/// A number of Arguments that stands in a column: the `index`-th under `name`.
struct VaryingNumber {
  std::string name;
  int index = 0;
  ColumnId column;
};

// ---- what the program defines ---------------------------------------------------------------------------------------

/// One FEAT statement. A label defined again is another definition; operations name definitions, not labels.
struct FeatureDef {
  std::string label;  ///< as written, without F( )
  const FeatureKind* kind = nullptr;
  Element nominal;     ///< in the frame current at the FEAT statement
  bool inner = false;  ///< INNER: the material is outside the radius
  /// Where some of the nominal is known only while the program runs: what it is made of, and the columns. Else empty.
  Arguments arguments = {};
  std::vector<VaryingNumber> varying = {};
};

/// One SNSDEF, or a sensor of the machine file by name.
struct SensorDef {
  std::string label;
  bool from_machine_file = false;  ///< then everything below comes from the machine file's `sensors`
  bool indexed = false;            ///< on the articulating head (INDEX), else fixed to the ram
  double head_a_rad = 0, head_b_rad = 0;
  Vec3 tip_in_r{0, 0, 0};  ///< FIXED: tip from the mounting point; INDEX: tip in the last link of the head; mm
  double radius_mm = 0;
  bool has_mount = false;     ///< an SNSMNT statement was in force
  Vec3 mount_offset_mm;       ///< SNSMNT MNTLEN: from the ram's mounting point to the head's centre
  double mount_turn_rad = 0;  ///< SNSMNT XVEC: turn of the head about the ram axis
  Span span;                  ///< in the program: of what defines or names it, or of the call of the module that does
};

struct FrameDef {
  std::string label;
};

struct ToleranceDef {
  std::string label;
  const ToleranceKind* kind = nullptr;
  Arguments arguments;  ///< features and datums as FeatureId values
  std::vector<VaryingNumber> varying = {};
};

/// MMC or LMC of a characteristic, on its feature or on a datum (engine/tolerances/material.hpp).
struct MaterialCondition {
  FeatureId feature;  ///< whose size departs from its size at the condition
  ToleranceId size;   ///< its tolerance of size
  Condition condition{};
};

/// A (features, tolerance) pair evaluated at one place of the program: what gets an uncertainty.
struct CharacteristicDef {
  std::vector<FeatureId> features;
  ToleranceId tolerance;
  int line = 0;
  std::vector<MaterialCondition> widening;  ///< of its zone, machine by machine
};

// ---- expressions over columns ---------------------------------------------------------------------------------------

enum class Op1 { negate, logical_not, abs, acos, asin, atan, cos, sin, tan, exp, ln, log10, sqrt, truncate, round };
enum class Op2 {
  add,
  subtract,
  multiply,
  divide,
  power,
  modulo,
  atan2,
  sign,
  minimum,
  maximum,
  equal,
  not_equal,
  less,
  less_equal,
  greater,
  greater_equal,
  logical_and,
  logical_or
};
struct PushConstant {
  double value = 0;
};
struct PushColumn {
  ColumnId column;
};
/// Replaces the 1-based index on top by that element of an array: column first + stride (index - 1).
struct PushElement {
  ColumnId first;
  int count = 0, stride = 1;
};
using Instruction = std::variant<PushConstant, PushColumn, PushElement, Op1, Op2>;
/// Postfix; leaves exactly one number. Logical values are 0 and 1.
using Expression = std::vector<Instruction>;

// ---- operations -----------------------------------------------------------------------------------------------------

/// The nominal of the feature is now in force, in the current frame. A label defined on several paths is one
/// feature: then `as` is the definition whose nominal it takes.
struct DefineFeature {
  FeatureId feature;
  FeatureId as = {};
};
struct SelectSensor {
  SensorId sensor;
};
/// PRCOMP: with compensation a touch yields the surface point, without it the centre of the tip.
struct SetCompensation {
  bool on = true;
};
/// TECOMP: whether the controller takes out the thermal expansion that it reckons with (workpiece file,
/// "compensation").
struct SetTemperatureCompensation {
  bool on = true;
};
/// Settings of the motion model. Lengths mm, speeds mm/s, accelerations mm/s^2.
enum class MotionSetting {
  approach,
  search,
  retract,
  clearance,
  depth,
  positioning_speed,
  measuring_speed,
  scan_speed,
  positioning_acceleration,
  measuring_acceleration,
  fly_radius
};
struct SetMotion {
  MotionSetting setting{};
  double value = 0;
  bool percent = false;
};
/// Straight move of the tip centre, current frame, mm; `relative`: by `to`, from where the tip is.
struct Move {
  Point to;
  bool relative = false;
};
/// FROM: keeps a point of the current frame as the home of the tip. GoHome moves there, or nowhere without a home.
struct SetHome {
  Point at;
};
struct GoHome {};
struct BeginMeasure {
  FeatureId feature;
};
/// One touch of the surface at `point` with outward vector `normal` (current frame, mm), for the feature
/// being measured. Without `has_normal` the nominal of the feature supplies the vector. With a
/// `pattern_count` it is touch `pattern_index` of the default pattern of the feature instead
/// (engine/features/pattern.hpp), in the frame in which the feature was defined, displaced by `point` in the
/// current frame.
struct Touch {
  FeatureId feature;
  Point point;
  Point normal;
  bool has_normal = true;
  int pattern_index = 0, pattern_count = 0;
};
/// Ends the measurement: fits the feature to the touches since BeginMeasure.
struct EndMeasure {
  FeatureId feature;
  FitCriterion criterion = FitCriterion::least_squares;
};
struct Construct {
  FeatureId result;
  const Construction* method = nullptr;
  std::vector<FeatureId> from;
  Arguments arguments;
  std::vector<VaryingNumber> varying = {};
};

/// F(x), what is programmed, used where FA(x) may stand: `result` is what the FEAT of `of` says, where it says it in the
/// coordinate system in which it was defined.
struct TakeNominal {
  FeatureId result, of;
};

struct DatumRef {
  FeatureId feature;
  bool gives_direction = false;
  AxisDirection direction;
  bool origin[3] = {false, false, false};
};
/// The next five make `result` and leave it current.
struct SetMachineFrame {
  FrameId result;
};
/// DATSET/TRMATX: at a known pose in the machine coordinate system of the program.
struct SetMatrixFrame {
  FrameId result;
  Rigid X_MD;
};
struct SetDatumFrame {
  FrameId result;
  std::vector<DatumRef> datums;
};
/// Along `axis` to the point of `from`, or by the length `by` where `from` names no feature.
struct OriginShift {
  Axis axis{};
  FeatureId from;
  Operand by;
};
struct TranslateFrame {
  FrameId result;
  std::vector<OriginShift> shifts;
};
struct RotateFrame {
  FrameId result;
  Axis axis{};
  FeatureId to;
  AxisDirection toward;
  Operand angle_rad;
};
struct RecallFrame {
  FrameId frame;
};

struct Evaluate {
  CharacteristicId characteristic;
};
/// OUTPUT of a coordinate system: its pose goes to the result file.
struct OutputFrame {
  FrameId frame;
};
/// OUTPUT: these features, in the current frame, and what was evaluated of them just before go to the result
/// file. `also`: SA(l), R(l), P(l) as written, which are only repeated there.
struct Output {
  std::vector<FeatureId> features;
  std::vector<CharacteristicId> characteristics;
  std::vector<std::string> also = {};
};
/// What OBTAIN can read of a measured feature, in the current frame. First vectors, a component each: its
/// point (mm), its direction, the ends of its touches along it, the vector that turns it and the third one
/// square to both, the apex of a cone, the foci of an ellipse, the points of two opposite faces. Then
/// numbers: mm or rad.
enum class Quantity {
  x,
  y,
  z,
  i,
  j,
  k,
  begin_x,
  begin_y,
  begin_z,
  end_x,
  end_y,
  end_z,
  second_i,
  second_j,
  second_k,
  third_i,
  third_j,
  third_k,
  apex_x,
  apex_y,
  apex_z,
  focus1_x,
  focus1_y,
  focus1_z,
  focus2_x,
  focus2_y,
  focus2_z,
  face1_x,
  face1_y,
  face1_z,
  face2_x,
  face2_y,
  face2_z,
  radius,
  minor_radius,
  angle,
  length,
  form
};
struct Obtain {
  ColumnId column;
  FeatureId feature;
  Quantity quantity{};
};
/// How far a measured feature lies from its nominal (engine/features/displacement.hpp): current frame, to
/// three columns.
struct ObtainDisplacement {
  ColumnId first;
  FeatureId feature;
};
/// To `column`; with an `index` to that element of the array of `count` elements that begins there.
struct Assign {
  ColumnId column;
  Expression value;
  Expression index = {};
  int count = 0, stride = 1;
};
/// What was evaluated last of these characteristics on the lane: the value, mm or rad, or whether it is
/// within its limits (1 or 0).
struct ObtainEvaluation {
  ColumnId column;
  std::vector<CharacteristicId> characteristics;
  bool status = false;
};
struct Jump {
  int target = 0;
};
/// Goes to `target` on the lanes where the condition is 0.
struct JumpUnless {
  Expression condition;
  int target = 0;
};

using Action = std::variant<DefineFeature, SelectSensor, SetCompensation, SetTemperatureCompensation, SetMotion, Move,
                            SetHome, GoHome, BeginMeasure, Touch, EndMeasure, Construct, TakeNominal, SetMachineFrame,
                            SetMatrixFrame, SetDatumFrame, TranslateFrame, RotateFrame, RecallFrame, Evaluate, Output,
                            OutputFrame, Obtain, ObtainDisplacement, ObtainEvaluation, Assign, Jump, JumpUnless>;

struct Operation {
  Action action;
  Span span;  ///< the statement it came from
  int line = 0;
};

struct Plan {
  std::string name;         ///< DMISMN text or the file name
  std::string result_name;  ///< FILNAM text; empty: the program gives none
  std::vector<Operation> operations;
  std::vector<FeatureDef> features;
  std::vector<SensorDef> sensors;
  std::vector<FrameDef> frames;
  std::vector<ToleranceDef> tolerances;
  std::vector<CharacteristicDef> characteristics;
  int columns = 0;

  const FeatureDef& operator[](FeatureId id) const { return features[id.value]; }
  const SensorDef& operator[](SensorId id) const { return sensors[id.value]; }
  const FrameDef& operator[](FrameId id) const { return frames[id.value]; }
  const ToleranceDef& operator[](ToleranceId id) const { return tolerances[id.value]; }
  const CharacteristicDef& operator[](CharacteristicId id) const { return characteristics[id.value]; }
};

/// The line and the labels: what evaluations have in common that reports tell apart by their occurrence.
using EvaluatedAs = std::pair<int, std::vector<std::string>>;
EvaluatedAs evaluated_as(const Plan&, const CharacteristicDef&);

/// The plan as readable text, one operation a line: for golden tests and `abbe check --plan`.
std::string to_text(const Plan&);

}  // namespace abbe::plan
