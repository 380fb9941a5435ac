// A recording repeated under a change: its rows, its baseline, its machine time and its program.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/diagnose/baseline/calibrated_part.hpp"
#include "engine/diagnose/baseline/machine_effects.hpp"
#include "engine/diagnose/planning/next_measurement.hpp"
#include "engine/run/motion.hpp"

namespace abbe::diagnose {

namespace {

/// New touches at most; of more, an even selection.
constexpr std::size_t kMostTouches = 240;
constexpr double kPause_s = 600;          // until the second recording begins
constexpr double kClearance_mm = 20;      // of the moves between touches

/// The rows that are repeated: indices in the order of measuring.
std::vector<int> selected(const Case& c, bool reversed) {
  const std::size_t n = c.rows.size(), m = std::min(n, kMostTouches);
  std::vector<int> out;
  for (std::size_t k = 0; k < n; ++k)
    if ((k + 1) * m / n > k * m / n) out.push_back(c.touches.touches[static_cast<std::size_t>(c.rows[k])].row);
  if (reversed) std::reverse(out.begin(), out.end());
  return out;
}

/// The last of each count, so that what is new counts on.
struct Last {
  int run = 0, visit = 0;
  double time_s = 0;
};
Last last_of(const Recording& r) {
  Last last;
  for (const RecordingRow& row : r.rows) {
    last.run = std::max(last.run, row.run);
    last.visit = std::max(last.visit, row.visit.value_or(0));
    last.time_s = std::max(last.time_s, row.time_s.value_or(0));
  }
  return last;
}

bool inside(const Machine& machine, const Vec3& reading) {
  for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
    const double end = machine[axis].direction * machine[axis].travel_mm, at = reading[static_cast<int>(axis)];
    if (at < std::min(0.0, end) || at > std::max(0.0, end)) return false;
  }
  return true;
}

bool displaced(const RecordedTouches& t) {
  return std::any_of(t.messages.begin(), t.messages.end(), [](const Diagnostic& d) { return d.code == Code::W0542; });
}

/// Definitions of all styli: the recording may know some that the machine file does not.
std::string definitions(const Longer& longer) {
  std::string out;
  std::set<std::string_view> defined;
  for (std::size_t k = longer.first; k < longer.touches.touches.size(); ++k) {
    const StylusScene& s = longer.touches.touches[k].scene.stylus;
    const auto named = longer.machine.sensors.find(std::string(s.name));
    if (named == longer.machine.sensors.end() || !defined.insert(s.name).second) continue;
    const Vec3 tip = named->second.tip_in_r_mm;
    out += s.indexed ? fmt::format("S({})=SNSDEF/PROBE,INDEX,POL,{:.4f},{:.4f},{:.6f},{:.6f},{:.6f},{:.4f},{:.4f}\n", s.name, s.head_a_rad * 180 / kPi,
                                   s.head_b_rad * 180 / kPi, tip.x / norm(tip), tip.y / norm(tip), tip.z / norm(tip), norm(tip), 2 * s.radius_mm)
                     : fmt::format("S({})=SNSDEF/PROBE,FIXED,CART,{:.4f},{:.4f},{:.4f},0,0,-1,{:.4f}\n", s.name, s.tip_from_mount_mm.x, s.tip_from_mount_mm.y,
                                   s.tip_from_mount_mm.z, 2 * s.radius_mm);
  }
  return out;
}

}  // namespace

std::optional<Longer> repeated(const Case& c, const Change& change) {
  Longer out{*c.recording, *c.machine, {}, 0};
  const Last last = last_of(*c.recording);
  const std::vector<int> rows = selected(c, change.reversed);
  const double begin_s = c.recording->rows[static_cast<std::size_t>(rows.front())].time_s.value_or(0);
  for (const int k : rows) {
    RecordingRow row = c.recording->rows[static_cast<std::size_t>(k)];
    const double residual_mm = dot(*row.normal, row.position_mm - *row.target_mm);
    row.run += last.run;
    if (row.visit) row.visit = change.reversed ? 2 * last.visit + 1 - *row.visit : *row.visit + last.visit;
    if (row.time_s) row.time_s = last.time_s + kPause_s + std::abs(*row.time_s - begin_s);
    change.apply(row, out.machine);
    row.position_mm = *row.target_mm + residual_mm * *row.normal;
    row.reading_mm.reset();                // of the first recording; where the axes will stand follows from the target
    out.recording.rows.push_back(std::move(row));
  }
  out.touches = recorded_touches(out.recording, out.machine, "");
  out.first = c.touches.touches.size();
  constexpr unsigned kReadings = static_cast<unsigned>(Covariate::raw_reading);
  out.touches.known |= c.touches.known & kReadings;
  out.touches.varying |= c.touches.known & kReadings;
  if (displaced(out.touches) && !displaced(c.touches)) return std::nullopt;
  for (std::size_t k = out.first; k < out.touches.touches.size(); ++k)
    if (!inside(out.machine, out.touches.touches[k].scene.reading)) return std::nullopt;
  return out;
}

Baseline baseline_of(const Case& c, const Longer& longer) {
  const KnownGeometry geometry{c.baseline.mean, c.baseline.factor};
  const bool known = !c.machine->known_state.empty();
  Baseline out = baseline_of(longer.touches, longer.machine,
                             {.surfaces = c.baseline.surfaces, .known = known ? &geometry : nullptr, .seed = c.options.seed, .threads = c.options.threads, .sampled = &geometry});
  add_doubts(EffectSet(longer.machine.effects, EffectUse::left_in, longer.machine.name), longer.touches, out);
  if (c.options.workpiece) calibrate(recorded_part(*c.options.workpiece, longer.recording, longer.touches, ""), longer.touches, out);
  return out;
}

double minutes_of(const Longer& longer) {
  const std::vector<RecordedTouch>& all = longer.touches.touches;
  const auto clear = [](const TouchScene& s) { return s.point + (s.stylus.radius_mm + kClearance_mm) * s.normal; };
  Motion motion(clear(all[longer.first].scene), default_motion(longer.machine));
  for (std::size_t k = longer.first; k < all.size(); ++k) {
    const TouchScene& s = all[k].scene;
    if (k > longer.first && s.stylus.tip_ordinal != all[k - 1].scene.stylus.tip_ordinal) motion.index_head();
    motion.settings().measuring_mm_s = s.speed_mm_s;
    motion.settings().measuring_mm_s2 = s.acceleration_mm_s2;
    motion.move_to(clear(s));
    motion.touch(s.point + s.stylus.radius_mm * s.normal, s.normal);
    motion.move_to(clear(s));
  }
  return motion.time_s() / 60;
}

std::string dmis_program(const Longer& longer, const Change& change) {
  std::string out = fmt::format("DMISMN/'{}',5.2\nUNITS/MM,ANGDEC\n", change.text);
  out += definitions(longer);
  if (!change.instruction.empty()) out += fmt::format("$$ before it: {}\nTEXT/OPER,'{}'\n", change.instruction, change.instruction);
  out += "MODE/PROG,MAN\nD(0)=DATSET/MCS\nSNSET/APPRCH,5\nSNSET/RETRCT,5\n";
  if (!change.statement.empty()) out += change.statement + "\n";
  std::string sensor;
  int number = 0;
  for (std::size_t k = longer.first; k < longer.touches.touches.size(); ++k) {
    const RecordedTouch& t = longer.touches.touches[k];
    const TouchScene& s = t.scene;
    const RecordingRow& row = longer.recording.rows[static_cast<std::size_t>(t.row)];
    if (s.stylus.name != sensor) out += fmt::format("SNSLCT/SA({})\n", sensor = std::string(s.stylus.name));
    const bool centre = longer.recording.point == RecordedPoint::tip_centre;
    const Vec3 n = s.normal, p = centre ? *row.target_mm - s.stylus.radius_mm * n : *row.target_mm, clear = p + (s.stylus.radius_mm + kClearance_mm) * n;
    const std::string point = fmt::format("{:.4f},{:.4f},{:.4f},{:.6f},{:.6f},{:.6f}", p.x, p.y, p.z, n.x, n.y, n.z);
    out += fmt::format("$$ {} touch {}\nF(P{})=FEAT/POINT,CART,{}\nGOTO/{:.4f},{:.4f},{:.4f}\n", row.feature, row.touch, ++number, point, clear.x, clear.y, clear.z);
    out += fmt::format("MEAS/POINT,F(P{0}),1\nPTMEAS/CART,{1}\nENDMES\nOUTPUT/FA(P{0})\n", number, point);
  }
  return out + "ENDFIL\n";
}

}  // namespace abbe::diagnose
