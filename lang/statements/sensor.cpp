// Sensors: SNSMNT, SNSDEF, SNSLCT. Frames: R is the last link of the head, z up; a stylus without
// tilt hangs along -z.
//
// Sources disagree on the sign of the mounting vector of SNSDEF and of the lengths in SNSMNT: some
// write the direction from the mount to the tip, some the opposite. Below a ram nothing can point
// up, so a stylus or a mount hangs down in either sign: a vector is turned round, of an offset from
// the ram only the height is. When the vector contradicts the head angles by more than a degree the
// angles hold, with a warning.
#include <fmt/format.h>

#include <cmath>

#include "engine/features/shape_traits.hpp"
#include "lang/statement.hpp"
#include "lang/statements/words.hpp"

namespace abbe::lang {

namespace {

void set_mount(Lowering& lowering, const RawStatement&, const Match& match) {
  const std::optional<Vec3> x = direction_vector(lowering, match, "xi"), z = direction_vector(lowering, match, "zi");
  if (!x || !z) return;
  if (std::hypot(x->x, x->y) < 1e-6 || std::fabs(std::fabs(z->z) - 1) > 1e-6)
    return lowering.error(Code::E0210, match.find("xi")->span,
                          "a mount must have ZVEC along the ram and XVEC across it",
                          "write ZVEC,0,0,-1 and an XVEC in the plane of x and y");
  Vec3 offset = vector_of(match, "dx");
  offset.z = -std::fabs(offset.z);
  lowering.mount.set(Mount{offset, std::atan2(x->y, x->x)});
}

/// Where the stylus points with head angles A, B: Rz(B) Ry(-A) (0, 0, -1), as
/// engine/machine/head.hpp turns.
Vec3 stylus_direction(double a_rad, double b_rad) {
  return {std::sin(a_rad) * std::cos(b_rad), std::sin(a_rad) * std::sin(b_rad), -std::cos(a_rad)};
}

/// Head angles that make the stylus point along `direction`; B is zero when it hangs down.
void point_head(plan::SensorDef& def, const Vec3& direction) {
  def.head_a_rad = std::acos(std::fmax(-1, std::fmin(1, -direction.z)));
  def.head_b_rad = std::hypot(direction.x, direction.y) > 0 ? std::atan2(direction.y + 0.0, direction.x) : 0;
}

void indexed_by_angles(Lowering& lowering, const Match& match, plan::SensorDef& def) {
  def.head_a_rad = match.number("a");
  def.head_b_rad = match.number("b");
  def.tip_in_r = {0, 0, -std::fabs(match.number("len"))};
  const std::optional<Vec3> along = direction_vector(lowering, match, "i");
  if (!along) return;
  const Vec3 stylus = stylus_direction(def.head_a_rad, def.head_b_rad);
  const bool straight_mount = std::fabs(std::fabs(along->z) - 1) < 1e-9;
  if (straight_mount || norm(cross(*along, stylus)) < kOneDegreeSine) return;
  lowering.warn(Code::W0223, match.find("i")->span,
                "this vector is neither along the ram nor along the stylus that the head angles give",
                "the head angles hold; 0,0,-1 is the usual vector");
}

/// From the mount to the tip, whichever way the vector was written.
Vec3 hanging(const Vec3& v) { return v.z > 0 ? -v : v; }

/// CART and VEC on the head: the head turns so that the stylus reaches from the head's centre to
/// the tip.
void indexed_by_vector(Lowering& lowering, const Match& match, plan::SensorDef& def, bool cartesian) {
  const std::optional<Vec3> to_tip = direction_vector(lowering, match, cartesian ? "dx" : "i");
  if (!to_tip) return;
  point_head(def, hanging(*to_tip));
  def.tip_in_r = {0, 0, -(cartesian ? norm(vector_of(match, "dx")) : std::fabs(match.number("len")))};
}

void fixed(Lowering& lowering, const Match& match, plan::SensorDef& def, bool cartesian) {
  const std::optional<Vec3> along = direction_vector(lowering, match, "i");
  if (!along) return;
  def.tip_in_r = cartesian ? vector_of(match, "dx") : std::fabs(match.number("len")) * hanging(*along);
  if (def.tip_in_r.z > 0) def.tip_in_r.z = -def.tip_in_r.z;
}

void define_sensor(Lowering& lowering, const RawStatement& raw, const Match& match) {
  if (const auto doubt = lowering.setting_doubts.find("SNSMNT"); doubt != lowering.setting_doubts.end())
    return lowering.fail(chain("what SNSMNT sets is in doubt", doubt->second));
  plan::SensorDef def;
  def.label = raw.label->name;
  def.span = lowering.here().first;
  def.indexed = match.text("carrier") == "INDEX";
  const std::string form = match.text("form");
  if (!def.indexed) {
    fixed(lowering, match, def, form == "CART");
  } else if (form == "POL") {
    indexed_by_angles(lowering, match, def);
  } else {
    indexed_by_vector(lowering, match, def, form == "CART");
  }
  def.radius_mm = match.number("diam") / 2;
  if (def.radius_mm <= 0)
    lowering.error(Code::E0210, match.find("diam")->span, "the diameter of the tip must be greater than zero",
                   "give the diameter of the ball");
  const std::optional<Mount>* mount = lowering.use(lowering.mount, "SNSMNT", raw.span);
  if (lowering.failed) return;
  if (*mount) {
    def.has_mount = true;
    def.mount_offset_mm = (*mount)->offset_mm;
    def.mount_turn_rad = (*mount)->turn_rad;
  }
  lowering.symbols.sensors.set(upper(def.label), {static_cast<int>(lowering.out.plan.sensors.size())});
  lowering.sensor_forms[static_cast<int>(lowering.out.plan.sensors.size())] = written_form(raw, match);
  lowering.out.plan.sensors.push_back(std::move(def));
}

void select_sensor(Lowering& lowering, const RawStatement&, const Match& match) {
  const LabelRef& label = match.find("sensor")->label;
  if (label.kind == "SA") lowering.sensor_of_machine_file(label);
  const std::optional<plan::SensorId> id = lowering.sensor(label);
  if (!id) return;
  lowering.emit(plan::SelectSensor{*id});
  lowering.sensor_selected = true;
  lowering.sensor_doubt.clear();
}

}  // namespace

extern const Statement kSnsmnt, kSnsdef, kSnslct;

const Statement kSnsmnt = {
    .word = "SNSMNT",
    .signature =
        "XVEC, xi:number, xj:number, xk:number, ZVEC, zi:number, zj:number, zk:number, "
        "MNTLEN, dx:length, dy:length, dz:length",
    .help =
        "How the head or probe hangs on the ram, for the sensors defined after it: XVEC turns it about "
        "the ram, MNTLEN "
        "leads from the ram to the head's centre. It hangs down whatever the sign of dz.",
    .example = "SNSMNT/XVEC,1,0,0,ZVEC,0,0,-1,MNTLEN,0,0,-175",
    .source = "ISO 22093, SNSMNT",
    .lower = set_mount,
    .doubt = Doubt::setting,
};
const Statement kSnsdef = {
    .word = "SNSDEF",
    .label = "S",
    .signature =
        "PROBE, ( carrier:FIXED, form:CART, dx:length, dy:length, dz:length, i:number, j:number, "
        "k:number, diam:length ; "
        "carrier:FIXED, form:VEC, i:number, j:number, k:number, len:length, diam:length ; "
        "carrier:INDEX, form:POL, a:angle, b:angle, i:number, j:number, k:number, len:length, "
        "diam:length ; "
        "carrier:INDEX, form:CART, dx:length, dy:length, dz:length, i:number, j:number, k:number, "
        "diam:length ; "
        "carrier:INDEX, form:VEC, i:number, j:number, k:number, len:length, diam:length ), [ tip:SPHERE ]",
    .help =
        "A touch probe. FIXED: the tip's offset from the mount. INDEX: on the articulating head at "
        "angles A (from straight "
        "down) and B (about the ram), from the head's centre to the ball `len`. A stylus hangs down in "
        "either sign of its vector.",
    .example = "S(P1)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,100,4",
    .source = "ISO 22093, SNSDEF",
    .lower = define_sensor,
};
const Statement kSnslct = {
    .word = "SNSLCT",
    .signature = "sensor:sensor",
    .help = "Puts a sensor to use. SA(name) not defined in the program comes from the machine file.",
    .example = "SNSLCT/S(P1)",
    .source = "ISO 22093, SNSLCT",
    .lower = select_sensor,
    .doubt = Doubt::sensor,
};

}  // namespace abbe::lang
