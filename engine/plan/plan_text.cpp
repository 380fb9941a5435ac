// The plan as text, one operation a line: "12  touch BORE at 10 20 -5 normal 0 0 1". Definitions
// stand before the operations that use them. Numbers are printed with the fewest digits that
// identify them, so equal plans give equal texts.
#include <fmt/format.h>

#include <iterator>
#include <map>

#include "engine/plan/plan.hpp"

namespace abbe::plan {

namespace {

constexpr std::string_view kSettings[] = {"approach",
                                          "search",
                                          "retract",
                                          "clearance",
                                          "depth",
                                          "positioning_speed",
                                          "measuring_speed",
                                          "scan_speed",
                                          "positioning_acceleration",
                                          "measuring_acceleration",
                                          "fly_radius"};
constexpr std::string_view kOp1[] = {"negate", "not", "abs", "acos",  "asin", "atan",     "cos",  "sin",
                                     "tan",    "exp", "ln",  "log10", "sqrt", "truncate", "round"};
constexpr std::string_view kOp2[] = {"+",   "-",  "*",  "/", "**", "mod", "atan2", "sign", "min",
                                     "max", "==", "!=", "<", "<=", ">",   ">=",    "and",  "or"};

constexpr std::string_view kCriteria[] = {"", " minimum zone", " maximum inscribed", " minimum circumscribed"};
constexpr std::string_view kQuantities[] = {
    "x",       "y",       "z",       "i",        "j",        "k",        "begin x",  "begin y",      "begin z",
    "end x",   "end y",   "end z",   "second i", "second j", "second k", "third i",  "third j",      "third k",
    "apex x",  "apex y",  "apex z",  "focus1 x", "focus1 y", "focus1 z", "focus2 x", "focus2 y",     "focus2 z",
    "face1 x", "face1 y", "face1 z", "face2 x",  "face2 y",  "face2 z",  "radius",   "minor_radius", "angle",
    "length",  "form"};

template <class Enum>
std::string_view name_of(Enum value, const auto& names) {
  return names[static_cast<std::size_t>(value)];
}

/// Whether the names end where the values do, so that a new value does not compile before it has its name.
template <class Enum>
constexpr bool name_all(const auto& names, Enum last) {
  return std::size(names) == static_cast<std::size_t>(last) + 1;
}
static_assert(name_all(kSettings, MotionSetting::fly_radius) && name_all(kOp1, Op1::round) &&
              name_all(kOp2, Op2::logical_or) && name_all(kCriteria, FitCriterion::minimum_circumscribed) &&
              name_all(kQuantities, Quantity::form));

char letter(Axis axis) { return "xyz"[static_cast<int>(axis)]; }
std::string text(const AxisDirection& d) { return fmt::format("{}{}", d.sign < 0 ? '-' : '+', letter(d.axis)); }
/// Adding zero turns -0 into 0.
std::string text(double value) { return fmt::format("{}", value + 0.0); }
std::string text(const Operand& o) {
  return o.column.valid() ? fmt::format("column {}", o.column.value) : text(o.constant);
}
std::string text(const Vec3& v) { return fmt::format("{} {} {}", text(v.x), text(v.y), text(v.z)); }
std::string text(const Point& p) { return fmt::format("{} {} {}", text(p[0]), text(p[1]), text(p[2])); }

bool is_zero(const Point& p) {
  for (const Operand& o : p)
    if (o.column.valid() || o.constant != 0) return false;
  return true;
}

std::string text(const Expression& expression) {
  std::string out;
  for (const Instruction& instruction : expression) {
    if (!out.empty()) out += ' ';
    if (const auto* c = std::get_if<PushConstant>(&instruction)) out += text(c->value);
    if (const auto* c = std::get_if<PushColumn>(&instruction)) out += fmt::format("column {}", c->column.value);
    if (const auto* e = std::get_if<PushElement>(&instruction))
      out += fmt::format("element of columns {} to {}", e->first.value, e->first.value + (e->count - 1) * e->stride);
    if (const auto* op = std::get_if<Op1>(&instruction)) out += name_of(*op, kOp1);
    if (const auto* op = std::get_if<Op2>(&instruction)) out += name_of(*op, kOp2);
  }
  return out;
}

/// One overload per operation.
class ActionText {
 public:
  explicit ActionText(const Plan& plan) : plan_(plan) {
    for (const FeatureDef& f : plan.features) ++definitions_[f.label];
  }

  std::string operator()(const DefineFeature& o) const {
    const FeatureDef& f = plan_[o.as.valid() ? o.as : o.feature];
    std::string out = fmt::format("define {} = {}{} at {} along {}", name(o.feature), f.kind->word,
                                  f.inner ? " inner" : "", text(f.nominal.point), text(f.nominal.direction));
    if (f.nominal.size != 0) out += fmt::format(" size {}", text(f.nominal.size));
    if (f.nominal.minor_size != 0) out += fmt::format(" minor {}", text(f.nominal.minor_size));
    if (f.nominal.angle != 0) out += fmt::format(" angle {}", text(f.nominal.angle));
    for (const VaryingNumber& v : f.varying) out += fmt::format(" {} column {}", v.name, v.column.value);
    return out;
  }
  std::string operator()(const SelectSensor& o) const {
    const SensorDef& s = plan_[o.sensor];
    if (s.from_machine_file) return fmt::format("sensor {} of the machine file", s.label);
    std::string out = fmt::format("sensor {}", s.label);
    if (s.indexed) out += fmt::format(" head {} {}", text(s.head_a_rad), text(s.head_b_rad));
    out += fmt::format(" tip {} radius {}", text(s.tip_in_r), text(s.radius_mm));
    if (s.has_mount) out += fmt::format(" mount {} turn {}", text(s.mount_offset_mm), text(s.mount_turn_rad));
    return out;
  }
  std::string operator()(const SetCompensation& o) const { return fmt::format("compensation {}", o.on ? "on" : "off"); }
  std::string operator()(const SetTemperatureCompensation& o) const {
    return fmt::format("temperature compensation {}", o.on ? "on" : "off");
  }
  std::string operator()(const SetMotion& o) const {
    return fmt::format("set {} {}{}", name_of(o.setting, kSettings), text(o.value), o.percent ? " percent" : "");
  }
  std::string operator()(const Move& o) const { return fmt::format("move {}{}", o.relative ? "by " : "", text(o.to)); }
  std::string operator()(const SetHome& o) const { return fmt::format("home {}", text(o.at)); }
  std::string operator()(const GoHome&) const { return "move home"; }
  std::string operator()(const BeginMeasure& o) const { return fmt::format("measure {}", name(o.feature)); }
  std::string operator()(const Touch& o) const {
    if (o.pattern_count > 0)
      return fmt::format("touch {} pattern {} of {}{}", name(o.feature), o.pattern_index + 1, o.pattern_count,
                         is_zero(o.point) ? "" : fmt::format(" displaced {}", text(o.point)));
    return fmt::format("touch {} at {}{}", name(o.feature), text(o.point),
                       o.has_normal ? fmt::format(" normal {}", text(o.normal)) : "");
  }
  std::string operator()(const EndMeasure& o) const {
    return fmt::format("fit {}{}", name(o.feature), name_of(o.criterion, kCriteria));
  }
  std::string operator()(const Construct& o) const {
    std::string out = fmt::format("construct {} = {}", name(o.result), o.method->word);
    for (const FeatureId f : o.from) out += fmt::format(" {}", name(f));
    return out;
  }
  std::string operator()(const TakeNominal& o) const {
    return fmt::format("take {} = nominal of {}", name(o.result), name(o.of));
  }
  std::string operator()(const SetMachineFrame& o) const {
    return fmt::format("frame {} = machine", plan_[o.result].label);
  }
  std::string operator()(const SetMatrixFrame& o) const {
    return fmt::format("frame {} = matrix x {} y {} z {} at {}", plan_[o.result].label, text(o.X_MD.R.cx),
                       text(o.X_MD.R.cy), text(o.X_MD.R.cz), text(o.X_MD.p));
  }
  std::string operator()(const SetDatumFrame& o) const {
    std::string out = fmt::format("frame {} = datums", plan_[o.result].label);
    for (const DatumRef& d : o.datums) {
      out += fmt::format(" {}", name(d.feature));
      if (d.gives_direction) out += fmt::format(" {}", text(d.direction));
      for (int k = 0; k < 3; ++k)
        if (d.origin[k]) out += fmt::format(" origin {}", "xyz"[k]);
    }
    return out;
  }
  std::string operator()(const TranslateFrame& o) const {
    std::string out = fmt::format("frame {} = translate", plan_[o.result].label);
    for (const OriginShift& s : o.shifts)
      out += fmt::format(" {} {}", letter(s.axis),
                         s.from.valid() ? fmt::format("to {}", name(s.from)) : fmt::format("by {}", text(s.by)));
    return out;
  }
  std::string operator()(const RotateFrame& o) const {
    const std::string how =
        o.to.valid() ? fmt::format("{} to {}", name(o.to), text(o.toward)) : fmt::format("by {}", text(o.angle_rad));
    return fmt::format("frame {} = rotate about {} {}", plan_[o.result].label, letter(o.axis), how);
  }
  std::string operator()(const RecallFrame& o) const { return fmt::format("recall frame {}", plan_[o.frame].label); }
  std::string operator()(const Output& o) const {
    std::string out = "output";
    for (const FeatureId f : o.features) out += fmt::format(" {}", name(f));
    for (const CharacteristicId c : o.characteristics) out += fmt::format(" {}", plan_[plan_[c].tolerance].label);
    for (const std::string& label : o.also) out += fmt::format(" {}", label);
    return out;
  }
  std::string operator()(const OutputFrame& o) const { return fmt::format("output frame {}", plan_[o.frame].label); }
  std::string operator()(const Evaluate& o) const {
    const CharacteristicDef& c = plan_[o.characteristic];
    const ToleranceDef& t = plan_[c.tolerance];
    std::string out = fmt::format("evaluate {} = {} of", t.label, t.kind->word);
    for (const FeatureId f : c.features) out += fmt::format(" {}", name(f));
    for (const int d : t.arguments.features("datum")) out += fmt::format(" datum {}", name(FeatureId{d}));
    for (const int d : t.arguments.features("reference")) out += fmt::format(" reference {}", name(FeatureId{d}));
    for (const MaterialCondition& m : c.widening)
      out += fmt::format(" widened by {} of {} at {}", plan_[m.size].label, name(m.feature),
                         m.condition == Condition::maximum_material ? "MMC" : "LMC");
    return out;
  }
  std::string operator()(const Obtain& o) const {
    return fmt::format("column {} = {} of {}", o.column.value, name_of(o.quantity, kQuantities), name(o.feature));
  }
  std::string operator()(const ObtainDisplacement& o) const {
    return fmt::format("columns {} to {} = displacement of {}", o.first.value, o.first.value + 2, name(o.feature));
  }
  std::string operator()(const ObtainEvaluation& o) const {
    std::string out = fmt::format("column {} = {} of", o.column.value, o.status ? "status" : "value");
    for (const CharacteristicId c : o.characteristics) out += fmt::format(" {}", plan_[plan_[c].tolerance].label);
    return out;
  }
  std::string operator()(const Assign& o) const {
    if (o.index.empty()) return fmt::format("column {} = {}", o.column.value, text(o.value));
    return fmt::format("column {} at {} = {}", o.column.value, text(o.index), text(o.value));
  }
  std::string operator()(const Jump& o) const { return fmt::format("jump {}", o.target); }
  std::string operator()(const JumpUnless& o) const {
    return fmt::format("jump {} unless {}", o.target, text(o.condition));
  }

 private:
  /// The label; with the definition's number when the label is defined more than once.
  std::string name(FeatureId id) const {
    const std::string& label = plan_[id].label;
    return definitions_.at(label) > 1 ? fmt::format("{}#{}", label, id.value) : label;
  }

  const Plan& plan_;
  std::map<std::string, int> definitions_;  ///< of each label
};

}  // namespace

std::string to_text(const Plan& plan) {
  std::string out = fmt::format("plan {}\n", plan.name);
  const ActionText action(plan);
  for (std::size_t i = 0; i < plan.operations.size(); ++i)
    out += fmt::format("{:4}  {}\n", i, std::visit(action, plan.operations[i].action));
  return out;
}

}  // namespace abbe::plan
