#include "engine/run/recorded/touch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "engine/machine/geometry.hpp"
#include "engine/run/curved_features.hpp"
#include "engine/run/motion.hpp"
#include "engine/run/part_frame.hpp"
#include "engine/run/recorded/from_program.hpp"
#include "engine/run/recorded/logged.hpp"
#include "engine/run/recorded/styli.hpp"
#include "engine/run/scene_terms.hpp"

namespace abbe {

namespace {

/// Rows in the order in which they were measured.
std::vector<int> order_of(const Recording& recording) {
  std::vector<int> order(recording.rows.size());
  std::iota(order.begin(), order.end(), 0);
  const bool timed = std::all_of(recording.rows.begin(), recording.rows.end(),
                                 [](const RecordingRow& r) { return r.time_s.has_value(); });
  if (timed)
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return *recording.rows[a].time_s < *recording.rows[b].time_s; });
  return order;
}

/// How far the recording must be moved to lie inside the travel: nothing when it does.
Vec3 placement(const Recording& recording, const Machine& machine, const std::vector<Vec3>& reading,
               RecordedTouches& out, const std::string& file) {
  Vec3 shift;
  double beyond_mm = 0;
  for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
    const int k = static_cast<int>(axis);
    const MachineAxis& a = machine[axis];
    const auto [low, high] = std::minmax_element(reading.begin(), reading.end(),
                                                 [k](const Vec3& one, const Vec3& other) { return one[k] < other[k]; });
    if (a.reaches((*low)[k]) && a.reaches((*high)[k])) continue;
    shift[k] = (a.lowest_mm() + a.highest_mm()) / 2 - ((*low)[k] + (*high)[k]) / 2;
    beyond_mm = std::max({beyond_mm, a.lowest_mm() - (*low)[k], (*high)[k] - a.highest_mm()});
  }
  if (shift == Vec3{} || recording.rows.empty()) return shift;
  out.messages.push_back(diagnostic(
      Code::W0542,
      fmt::format(
          "{}: the touches reach {:.3g} mm beyond the travel of machine '{}'; they are taken as made in the middle "
          "of it, {:.1f}, {:.1f}, {:.1f} mm from where they stand",
          file, beyond_mm, machine.name, shift.x + 0.0, shift.y + 0.0, shift.z + 0.0),
      "errors of the machine depend on the place: record machine coordinates, or name the right machine"));
  return shift;
}

/// How a part stood is not in its own coordinates.
void doubt_axes(const Recording& recording, RecordedTouches& out, const std::string& file) {
  if (!recording.in_part_frame) return;
  out.messages.push_back(diagnostic(
      Code::W0558,
      fmt::format("{}: in part coordinates; the axes of the part are taken for those of the machine", file),
      "if the part stood turned, errors of machine, head and probe are sought in the wrong directions: record machine coordinates"));
}

int label_index(std::vector<std::string>& labels, const std::string& label) {
  const auto index = std::find(labels.begin(), labels.end(), label) - labels.begin();
  if (index == static_cast<std::ptrdiff_t>(labels.size())) labels.push_back(label);
  return static_cast<int>(index);
}

/// What the scene has of time, motion and temperatures; what was not logged stays at its usual value.
void fill_covariates(const RecordingRow& row, const Machine& machine, int ordinal, TouchScene& scene) {
  const MotionSettings usual = default_motion(machine);
  scene.time_s = row.time_s.value_or(kUsualInterval_s * ordinal);
  scene.speed_mm_s = row.speed_mm_s.value_or(usual.measuring_mm_s);
  scene.acceleration_mm_s2 = row.accel_mm_s2.value_or(usual.measuring_mm_s2);
  scene.travel = row.travel.value_or(-scene.normal);

  scene.settled_s = 0;  // not logged: what rings is taken as it is right after the ramp
  scene.temperature.part = row.temp_part_C.value_or(kReferenceTemperature_C);
  scene.temperature.scale[0] = row.temp_x_C.value_or(kReferenceTemperature_C);
  scene.temperature.scale[1] = row.temp_y_C.value_or(kReferenceTemperature_C);
  scene.temperature.scale[2] = row.temp_z_C.value_or(kReferenceTemperature_C);
  scene.temperature.air = row.temp_air_C.value_or(kReferenceTemperature_C);
  scene.load_kg = row.load_kg.value_or(0);
  scene.setup = row.setup;
  scene.run = row.run;
  scene.qualification = row.qualification.value_or(1);
}

/// The centre of the tip at the target of a row.
Vec3 tip_at_target(const RecordingRow& row, RecordedPoint point, const Sensor& sensor) {
  return *row.target_mm + (point == RecordedPoint::surface ? sensor.radius_mm * *row.normal : Vec3{});
}

/// The point of the surface that the tip touches there.
Vec3 surface_at_target(const RecordingRow& row, RecordedPoint point, const Sensor& sensor) {
  return point == RecordedPoint::surface ? *row.target_mm : *row.target_mm - sensor.radius_mm * *row.normal;
}

/// Where on the part touches lie: as its program says, as a recording in part coordinates has it, or as the setups hang
/// together (part_frame.hpp).
class OnPart {
 public:
  /// `surfaces`: by row.
  OnPart(const Recording& recording, const std::vector<Vec3>& surfaces)
      : planned_(lies_as_planned(recording)),
        in_part_frame_(recording.in_part_frame),
        frames_(aimed(recording, surfaces)) {}

  void place(const RecordingRow& row, const Vec3& surface, TouchScene& s) const {
    if (planned_)
      s.on_part = *row.on_part_mm, s.normal_on_part = *row.normal_on_part;
    else if (in_part_frame_)
      s.on_part = surface, s.normal_on_part = s.normal;
    else
      s.on_part = frames_.on_part(row.setup, surface),
      s.normal_on_part = frames_.direction_on_part(row.setup, s.normal);
  }

 private:
  static std::vector<AimedTouch> aimed(const Recording& recording, const std::vector<Vec3>& surfaces) {
    std::vector<AimedTouch> all;
    for (std::size_t i = 0; i < recording.rows.size(); ++i) {
      const RecordingRow& row = recording.rows[i];
      all.push_back({row.setup, row.feature, row.touch, surfaces[i], *row.normal});
    }
    return all;
  }

  bool planned_, in_part_frame_;
  PartFrames frames_;
};

/// Scenes point to the names of their sensors, which must outlive them.
void keep_names(const std::vector<const Sensor*>& sensor_of, RecordedTouches& out) {
  const auto names = std::make_shared<std::set<std::string>>();
  for (RecordedTouch& t : out.touches) t.scene.stylus.name = *names->insert(sensor_of[t.row]->name).first;
  out.names = names;
}

/// Senses of the axes and indexing visits follow from the sequence of touches.
void follow_sequence(const Recording& recording, std::vector<RecordedTouch>& touches) {
  constexpr double kMoves = 0.02;  // an axis that takes this share of the way counts as moving
  int sense[3] = {1, 1, 1}, turned = 0, count = 0;
  std::map<std::pair<int, int>, int> visits;  // by number in each run, which may count its own
  const RecordedTouch* before = nullptr;
  for (RecordedTouch& t : touches) {
    for (int k = 0; k < 3; ++k) {
      if (std::abs(t.scene.travel[k]) > kMoves) sense[k] = t.scene.travel[k] > 0 ? 1 : -1;
      t.scene.sense[k] = sense[k];
      t.scene.since_reversal_mm[k] = 1000;
    }
    const bool stays = before && t.scene.stylus.head_a_rad == before->scene.stylus.head_a_rad &&
        t.scene.stylus.head_b_rad == before->scene.stylus.head_b_rad;
    if (!stays) ++turned;
    const std::optional<int>& logged = recording.rows[t.row].visit;
    // A log whose number stays as it was when a run begins says that the head was not indexed for it.
    const bool goes_on = stays && logged && t.file == before->file && logged == recording.rows[before->row].visit;
    const auto [visit, is_new] =
        visits.try_emplace({t.scene.run, logged.value_or(turned)}, goes_on ? before->scene.visit : count);
    if (is_new && !goes_on) ++count;
    t.scene.visit = visit->second;
    before = &t;
  }
}

void find_curved(RecordedTouches& out) {
  CurvedFeatures touched;
  for (const RecordedTouch& t : out.touches)
    touched.add(out.features[t.scene.feature], t.scene.setup, t.scene.on_part, t.scene.normal_on_part);
  const std::set<std::string> curved = touched.curved();
  for (RecordedTouch& t : out.touches) t.scene.curved = curved.count(out.features[t.scene.feature]) > 0;
}

}  // namespace

TouchScene scene_for(const Effect& effect, const RecordedTouch& touch) {
  TouchScene scene = touch.scene;
  if (needs_raw_reading(effect)) scene.reading += touch.beyond_target_mm;
  return scene;
}

double lasts_s(const RecordedTouches& t) {
  return std::max(1.0, t.touches.back().scene.time_s - t.touches.front().scene.time_s);
}

std::vector<int> surface_points(const RecordedTouches& t) {
  constexpr double kSame_mm = 2e-3;
  std::map<int, std::vector<std::pair<Vec3, int>>> known;  // by feature
  std::vector<int> out;
  int count = 0;
  for (const RecordedTouch& touch : t.touches) {
    std::vector<std::pair<Vec3, int>>& points = known[touch.scene.feature];
    auto same = std::find_if(points.begin(), points.end(),
                             [&](const auto& p) { return norm(p.first - touch.scene.on_part) < kSame_mm; });
    if (same == points.end()) same = points.insert(points.end(), {touch.scene.on_part, count++});
    out.push_back(same->second);
  }
  return out;
}

void require_targets(const Recording& recording, const std::string& file) {
  for (const RecordingRow& row : recording.rows) {
    if (row.target_mm && row.normal) continue;
    throw UserError(diagnostic(Code::E0543,
                               fmt::format("{}:{}: touch {} of '{}' has no {}", file_of(recording, row, file), row.line,
                                           row.touch, row.feature, row.target_mm ? "normal" : "target"),
                               fmt::format("give the columns {}, or the measurement program with --program",
                                           row.target_mm    ? "nx, ny, nz"
                                               : row.normal ? "tx, ty, tz"
                                                            : "tx, ty, tz, nx, ny, nz")));
  }
}

RecordedTouches recorded_touches(const Recording& recording, const Machine& machine, const std::string& file) {
  ABBE_CHECK(!recording.rows.empty());
  RecordedTouches out;
  require_targets(recording, file);
  RecordedStyli styli(recording, machine, file);
  std::vector<const Sensor*> sensor_of;
  std::vector<Vec3> readings, surfaces;
  for (const RecordingRow& row : recording.rows) {
    const Sensor& sensor = *sensor_of.emplace_back(&styli.of(row));
    readings.push_back(tip_at_target(row, recording.point, sensor) - machine.home_offset() - sensor.tip_from_mount_mm);
    surfaces.push_back(surface_at_target(row, recording.point, sensor));
  }
  out.styli = styli.names();
  out.tips = styli.tips();
  out.messages = styli.messages();
  const Logged logged = logged_covariates(recording, sensor_of, styli);
  out.known = logged.known;
  out.varying = logged.varying;
  doubt_axes(recording, out, file);
  const Vec3 shift = placement(recording, machine, readings, out, file);
  const OnPart on_part(recording, surfaces);
  for (const int i : order_of(recording)) {
    const RecordingRow& row = recording.rows[i];
    const Sensor& sensor = *sensor_of[i];
    RecordedTouch t;
    t.row = i, t.file = row.file;
    t.residual_mm = dot(*row.normal, row.position_mm - *row.target_mm);
    t.per_rad_a_mm = sensor.per_rad_a_mm;
    t.per_rad_b_mm = sensor.per_rad_b_mm;
    TouchScene& s = t.scene;
    s.normal = *row.normal;
    s.point = surfaces[i] + shift;
    s.reading = readings[i] + shift;
    on_part.place(row, surfaces[i], s);
    s.stylus = stylus_scene(sensor);
    s.touch = static_cast<int>(out.touches.size());
    s.feature = label_index(out.features, row.feature);
    fill_covariates(row, machine, s.touch, s);
    set_structure(machine, s);
    if (row.reading_mm) {
      t.beyond_target_mm = t.residual_mm * s.normal;
      s.reading = *row.reading_mm - t.residual_mm * s.normal;
    }
    out.touches.push_back(std::move(t));
  }
  keep_names(sensor_of, out);
  follow_sequence(recording, out.touches);
  find_curved(out);
  return out;
}

}  // namespace abbe
