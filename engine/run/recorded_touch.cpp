#include "engine/run/recorded_touch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <numeric>
#include <variant>

#include "engine/base/letter_case.hpp"
#include "engine/machine/geometry.hpp"
#include "engine/math/units.hpp"
#include "engine/run/curved_features.hpp"
#include "engine/run/motion.hpp"
#include "engine/run/part_frame.hpp"
#include "engine/run/scene_terms.hpp"
#include "engine/run/sensor.hpp"

namespace abbe {

namespace {

struct CovariateColumns {
  Covariate covariate;
  std::vector<std::string> columns;
};

const std::vector<CovariateColumns>& covariate_columns() {
  static const std::vector<CovariateColumns> all = {
      {Covariate::position, {"x", "y", "z"}},
      {Covariate::normal, {"nx", "ny", "nz"}},
      {Covariate::time, {"time_s"}},
      {Covariate::speed, {"speed_mm_s"}},
      {Covariate::acceleration, {"accel_mm_s2"}},
      {Covariate::direction, {"ax", "ay", "az"}},
      {Covariate::head, {"head_A_deg", "head_B_deg"}},
      {Covariate::sensor, {"sensor"}},
      {Covariate::part_temperature, {"temp_part_C"}},
      {Covariate::scale_temperature, {"temp_x_C", "temp_y_C", "temp_z_C"}},
      {Covariate::air_temperature, {"temp_air_C"}},
      {Covariate::gradients, {}},
      {Covariate::raw_reading, {"enc_x", "enc_y", "enc_z"}},
      {Covariate::load, {"load_kg"}},
      {Covariate::visit, {"visit"}},
      {Covariate::qualification, {"qualification"}},
      {Covariate::part_frame, {"tx", "ty", "tz"}},
      {Covariate::feature, {"feature"}},
  };
  return all;
}

/// What a covariate holds: a figure, or the name of a sensor or feature.
using CovariateValue = std::variant<double, std::string>;
using CovariateValues = std::vector<CovariateValue>;

/// The angles of the head: those of the row, or where it has none those that are stated of the stylus it
/// names. Empty where neither says.
CovariateValues head_angles(const RecordingRow& r, const Sensor& sensor) {
  const bool stated = (r.head_a_deg && r.head_b_deg) || r.sensor;
  return stated ? CovariateValues{sensor.head_a_rad, sensor.head_b_rad} : CovariateValues{};
}

/// The values of a covariate in a row; empty when it was not logged.
CovariateValues values(Covariate c, const RecordingRow& r, const Sensor& sensor) {
  const auto given = [](std::initializer_list<std::optional<double>> list) {
    CovariateValues v;
    for (const auto& x : list)
      if (x) v.emplace_back(*x);
    return v.size() == list.size() ? v : CovariateValues{};
  };
  const auto of = [](const std::optional<int>& v) { return v ? std::optional<double>(*v) : std::nullopt; };
  const auto of_vector = [](const std::optional<Vec3>& v) {
    return v ? CovariateValues{v->x, v->y, v->z} : CovariateValues{};
  };
  switch (c) {
    case Covariate::position: return of_vector(r.target_mm);
    case Covariate::part_frame: return of_vector(r.target_mm);
    case Covariate::normal: return of_vector(r.normal);
    case Covariate::time: return given({r.time_s});
    case Covariate::speed: return given({r.speed_mm_s});
    case Covariate::acceleration: return given({r.accel_mm_s2});
    case Covariate::direction: return of_vector(r.travel);
    case Covariate::head: return head_angles(r, sensor);
    case Covariate::sensor: return r.sensor ? CovariateValues{*r.sensor} : CovariateValues{};
    case Covariate::part_temperature: return given({r.temp_part_C});
    case Covariate::scale_temperature: return given({r.temp_x_C, r.temp_y_C, r.temp_z_C});
    case Covariate::air_temperature: return given({r.temp_air_C});
    case Covariate::gradients: return {};
    case Covariate::raw_reading: return of_vector(r.reading_mm);
    case Covariate::load: return given({r.load_kg});
    case Covariate::visit:
      return head_angles(r, sensor).empty() ? CovariateValues{} : CovariateValues{double(r.visit.value_or(0))};
    case Covariate::qualification: return given({of(r.qualification)});
    case Covariate::feature: return {r.feature};
  }
  return {};
}

/// `sensors`: by row.
void find_covariates(const Recording& recording, const std::vector<const Sensor*>& sensors, RecordedTouches& out) {
  for (const CovariateColumns& entry : covariate_columns()) {
    bool known = true, varying = false;
    const CovariateValues first = values(entry.covariate, recording.rows.front(), *sensors.front());
    for (std::size_t i = 0; i < recording.rows.size(); ++i) {
      const CovariateValues v = values(entry.covariate, recording.rows[i], *sensors[i]);
      known = known && !v.empty();
      if (known && v != first) varying = true;
    }
    if (known) out.known = out.known | entry.covariate;
    if (known && varying) out.varying = out.varying | entry.covariate;
  }
}

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

/// The sensors of a recording, resolved once each: by name, and by the angles of the head where rows give them. Angles
/// that were read back scatter by thousandths of a degree about those that the head was sent to.
class Sensors {
 public:
  Sensors(const Machine& machine, const std::string& file) : machine_(machine), file_(file) {}

  const Sensor& of(const RecordingRow& row, RecordedTouches& out) {
    const std::string name = row.sensor.value_or("");
    std::deque<Known>& same_name = known_[upper(name)];
    for (const Known& known : same_name)
      if (is_near(known.a_deg, row.head_a_deg) && is_near(known.b_deg, row.head_b_deg)) return known.sensor;
    Sensor sensor = resolve(name, row, out);
    sensor.ordinal = stylus_ordinal(sensor, met_);
    met_.push_back(sensor);
    sensor.tip_ordinal = out.tips = static_cast<int>(met_.size());
    if (static_cast<int>(out.styli.size()) < sensor.ordinal) out.styli.push_back(sensor.name);
    same_name.push_back({row.head_a_deg, row.head_b_deg, std::move(sensor)});
    return same_name.back().sensor;
  }

 private:
  struct Known {
    std::optional<double> a_deg, b_deg;
    Sensor sensor;
  };

  static bool is_near(const std::optional<double>& a_deg, const std::optional<double>& b_deg) {
    constexpr double kReadBack_deg = 0.1;
    return a_deg && b_deg ? std::abs(*a_deg - *b_deg) < kReadBack_deg : a_deg.has_value() == b_deg.has_value();
  }

  Sensor resolve(const std::string& name, const RecordingRow& row, RecordedTouches& out) {
    plan::SensorDef def;
    def.label = name;
    def.from_machine_file = !name.empty();
    if (name.empty()) assume(row, def, out);
    const SourceFile nowhere(file_, "");
    if (def.from_machine_file) require_sensor(def.label, row);
    Sensor sensor = resolve_sensor(def, machine_, nowhere);
    if (!def.from_machine_file || !row.head_a_deg || !row.head_b_deg) return sensor;
    // The head may stand elsewhere than the machine file says of this stylus system.
    Machine turned = machine_;
    NamedSensor& s = turned.sensors.at(sensor.name);
    s.head_a_rad = *row.head_a_deg * kDegree;
    s.head_b_rad = *row.head_b_deg * kDegree;
    return resolve_sensor(def, turned, nowhere);
  }

  void require_sensor(const std::string& label, const RecordingRow& row) const {
    if (machine_.sensors.contains(label)) return;
    std::vector<std::string_view> names;
    for (const auto& [name, sensor] : machine_.sensors) names.push_back(name);
    const std::string near = nearest_word(label, names);
    throw UserError(diagnostic(
        Code::E0301,
        fmt::format("{}:{}: neither the recording nor machine '{}' says what sensor '{}' is", file_, row.line,
                    machine_.name, label),
        near.empty()
            ? fmt::format(
                  "add the line '# sensor {}: head_deg A B tip_in_r_mm x y z diameter_mm d', or the sensor to the machine file",
                  label)
            : fmt::format("did you mean '{}'?", near)));
  }

  /// A recording that does not name its stylus: the machine's only one, or a usual one, straight down.
  void assume(const RecordingRow& row, plan::SensorDef& def, RecordedTouches& out) {
    if (machine_.sensors.size() == 1) {
      def.label = machine_.sensors.begin()->first;
      def.from_machine_file = true;
    } else {
      def.label = "assumed";
      def.indexed = row.head_a_deg && row.head_b_deg;
      def.head_a_rad = row.head_a_deg.value_or(0) * kDegree;
      def.head_b_rad = row.head_b_deg.value_or(0) * kDegree;
      def.tip_in_r = {0, 0, -100};
      def.radius_mm = 1;
    }
    if (said_) return;
    said_ = true;
    out.messages.push_back(
        diagnostic(Code::W0541,
                   fmt::format("{}: rows do not name their stylus: '{}' is assumed{}", file_, def.label,
                               def.from_machine_file ? "" : ", 100 mm straight from the head, 2 mm ball"),
                   "add the column 'sensor', and the sensor to the machine file"));
  }

  const Machine& machine_;
  std::string file_;
  std::map<std::string, std::deque<Known>> known_;  ///< by name
  std::vector<Sensor> met_;
  bool said_ = false;
};

/// How far the recording must be moved to lie inside the travel: nothing when it does.
Vec3 placement(const Recording& recording, const Machine& machine, const std::vector<Vec3>& reading,
               RecordedTouches& out, const std::string& file) {
  Vec3 shift;
  for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
    const int k = static_cast<int>(axis);
    const double end = machine[axis].direction * machine[axis].travel_mm;
    const auto [low, high] =
        std::minmax_element(reading.begin(), reading.end(), [k](const Vec3& a, const Vec3& b) { return a[k] < b[k]; });
    if ((*low)[k] >= std::min(0.0, end) && (*high)[k] <= std::max(0.0, end)) continue;
    shift[k] = end / 2 - ((*low)[k] + (*high)[k]) / 2;
  }
  if (shift == Vec3{} || recording.rows.empty()) return shift;
  out.messages.push_back(diagnostic(
      Code::W0542,
      fmt::format("{}: the touches lie outside the travel of machine '{}'; they are taken as made in the middle of it, "
                  "{:.0f}, {:.0f}, {:.0f} mm from where they stand",
                  file, machine.name, shift.x, shift.y, shift.z),
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
  constexpr double kTypicalInterval_s = 5;
  const MotionSettings usual = default_motion(machine);
  scene.time_s = row.time_s.value_or(kTypicalInterval_s * ordinal);
  scene.speed_mm_s = row.speed_mm_s.value_or(usual.measuring_mm_s);
  scene.acceleration_mm_s2 = row.accel_mm_s2.value_or(usual.measuring_mm_s2);
  scene.travel = row.travel.value_or(-scene.normal);

  scene.settled_s = 0;  // not logged: what rings is taken as it is right after the ramp
  scene.temperature.part = row.temp_part_C.value_or(20);
  scene.temperature.scale[0] = row.temp_x_C.value_or(20);
  scene.temperature.scale[1] = row.temp_y_C.value_or(20);
  scene.temperature.scale[2] = row.temp_z_C.value_or(20);
  scene.temperature.air = row.temp_air_C.value_or(20);
  scene.load_kg = row.load_kg.value_or(0);
  scene.setup = row.setup;
  scene.run = row.run;
  scene.qualification = row.qualification.value_or(1);
}

/// Senses of the axes and indexing visits follow from the sequence of touches.
void follow_sequence(const Recording& recording, std::vector<RecordedTouch>& touches) {
  constexpr double kMoves = 0.02;  // an axis that takes this share of the way counts as moving
  int sense[3] = {1, 1, 1}, visit = 0;
  std::map<std::pair<int, int>, int> visits;  // every run counts its own
  double a = 1e9, b = 1e9;
  for (RecordedTouch& t : touches) {
    for (int k = 0; k < 3; ++k) {
      if (std::abs(t.scene.travel[k]) > kMoves) sense[k] = t.scene.travel[k] > 0 ? 1 : -1;
      t.scene.sense[k] = sense[k];
      t.scene.since_reversal_mm[k] = 1000;
    }
    if (t.scene.stylus.head_a_rad != a || t.scene.stylus.head_b_rad != b) ++visit;
    a = t.scene.stylus.head_a_rad;
    b = t.scene.stylus.head_b_rad;
    const std::pair logged{t.scene.run, recording.rows[t.row].visit.value_or(visit)};
    t.scene.visit = visits.emplace(logged, static_cast<int>(visits.size())).first->second;
  }
}

void require_target(const RecordingRow& row, const std::string& file) {
  if (row.target_mm && row.normal) return;
  throw UserError(diagnostic(Code::E0543,
                             fmt::format("{}:{}: touch {} of '{}' has no {}", file, row.line, row.touch, row.feature,
                                         row.target_mm ? "normal" : "target"),
                             "give the columns tx, ty, tz, nx, ny, nz, or the measurement program with --program"));
}

void find_curved(RecordedTouches& out) {
  CurvedFeatures curved;
  for (const RecordedTouch& t : out.touches)
    curved.add(out.features[t.scene.feature], t.scene.setup, t.scene.normal_on_part);
  for (RecordedTouch& t : out.touches) t.scene.curved = curved.has(out.features[t.scene.feature]);
}

}  // namespace

TouchScene scene_for(const Effect& effect, const RecordedTouch& touch) {
  TouchScene scene = touch.scene;
  if (needs_raw_reading(effect)) scene.reading += touch.beyond_target_mm;
  return scene;
}

RecordedTouches recorded_touches(const Recording& recording, const Machine& machine, const std::string& file) {
  ABBE_CHECK(!recording.rows.empty());
  RecordedTouches out;
  for (const RecordingRow& row : recording.rows) require_target(row, file);
  Sensors sensors(machine, file);
  std::vector<Vec3> readings;
  std::vector<const Sensor*> sensor_of;
  for (const RecordingRow& row : recording.rows) {
    const Sensor& sensor = sensors.of(row, out);
    sensor_of.push_back(&sensor);
    const Vec3 tip =
        *row.target_mm + (recording.point == RecordedPoint::surface ? sensor.radius_mm * *row.normal : Vec3{});
    readings.push_back(tip - machine.home_offset() - sensor.tip_from_mount_mm);
  }
  find_covariates(recording, sensor_of, out);
  doubt_axes(recording, out, file);
  const Vec3 shift = placement(recording, machine, readings, out, file);
  const auto surface_of = [&](std::size_t i) {
    const RecordingRow& row = recording.rows[i];
    return recording.point == RecordedPoint::surface ? *row.target_mm
                                                     : *row.target_mm - sensor_of[i]->radius_mm * *row.normal;
  };
  std::vector<AimedTouch> aimed;
  for (std::size_t i = 0; i < recording.rows.size(); ++i)
    aimed.push_back({recording.rows[i].setup, recording.rows[i].feature, recording.rows[i].touch, surface_of(i),
                     *recording.rows[i].normal});
  const PartFrames part(aimed);
  const bool planned = lies_as_planned(recording);
  for (const int i : order_of(recording)) {
    const RecordingRow& row = recording.rows[i];
    const Sensor& sensor = *sensor_of[i];
    RecordedTouch t;
    t.row = i;
    t.residual_mm = dot(*row.normal, row.position_mm - *row.target_mm);
    t.per_rad_a_mm = sensor.per_rad_a_mm;
    t.per_rad_b_mm = sensor.per_rad_b_mm;
    TouchScene& s = t.scene;
    s.normal = *row.normal;
    const Vec3 surface = surface_of(static_cast<std::size_t>(i));
    s.point = surface + shift;
    s.reading = readings[i] + shift;
    if (planned)
      s.on_part = *row.on_part_mm, s.normal_on_part = *row.normal_on_part;
    else if (recording.in_part_frame)
      s.on_part = surface, s.normal_on_part = s.normal;
    else
      s.on_part = part.on_part(row.setup, surface), s.normal_on_part = part.direction_on_part(row.setup, s.normal);
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
  for (RecordedTouch& t : out.touches) t.scene.stylus.name = *out.names.insert(sensor_of[t.row]->name).first;
  follow_sequence(recording, out.touches);
  find_curved(out);
  return out;
}

namespace {

/// A row in part coordinates, in the machine coordinates of the program.
void carry(const Rigid& X_MD, RecordingRow& row) {
  row.position_mm = X_MD * row.position_mm;
  if (row.target_mm) row.target_mm = X_MD * *row.target_mm;
  for (std::optional<Vec3>* direction : {&row.normal, &row.travel})
    if (*direction) *direction = X_MD.R * **direction;
}

}  // namespace

bool lies_as_planned(const Recording& recording) {
  return std::all_of(recording.rows.begin(), recording.rows.end(),
                     [](const RecordingRow& row) { return row.on_part_mm && row.normal_on_part; });
}

void complete_from_program(Recording& recording, const MachineRecord& nominal, const std::string& file) {
  std::map<std::pair<std::string, int>, std::size_t> partner;
  for (std::size_t k = 0; k < nominal.recording.rows.size(); ++k)
    partner[{upper(nominal.recording.rows[k].feature), nominal.recording.rows[k].touch}] = k;
  for (const auto& line : nominal.recording.metadata) recording.metadata.push_back(line);
  FrameCount frames;
  const auto surface_of = [&](std::size_t k) -> Vec3 {
    const RecordingRow& row = nominal.recording.rows[k];
    return *row.target_mm - nominal.aims[k].radius_mm * *row.normal;
  };
  for (std::size_t k = 0; k < nominal.aims.size(); ++k) frames.add(nominal.aims[k].X_MD, surface_of(k));
  const Rigid X_PM = inverse(frames.of_part(Rigid{}));
  std::vector<std::string> lost;
  std::size_t paired = 0;
  for (RecordingRow& row : recording.rows) {
    const auto found = partner.find({upper(row.feature), row.touch});
    if (found == partner.end()) {
      if (!row.target_mm || !row.normal || recording.in_part_frame)
        lost.push_back(fmt::format("line {}: '{}' touch {}", row.line, row.feature, row.touch));
      continue;
    }
    ++paired;
    RecordingRow from = nominal.recording.rows[found->second];
    const TouchAim& aim = nominal.aims[found->second];
    row.feature = from.feature;  // labels are the same whatever their case
    if (recording.in_part_frame) carry(aim.X_MD, row);
    const Vec3 surface = surface_of(found->second);
    row.on_part_mm = X_PM * surface;
    row.normal_on_part = X_PM.R * *from.normal;
    if (recording.point == RecordedPoint::surface) from.target_mm = surface;
    const auto fill = [&](auto member) {
      if (!(row.*member)) row.*member = from.*member;
    };
    row.travel_as_planned = !row.travel;
    fill(&RecordingRow::target_mm), fill(&RecordingRow::normal), fill(&RecordingRow::sensor);
    fill(&RecordingRow::head_a_deg), fill(&RecordingRow::head_b_deg), fill(&RecordingRow::visit);
    fill(&RecordingRow::speed_mm_s), fill(&RecordingRow::accel_mm_s2), fill(&RecordingRow::travel);
  }
  recording.in_part_frame = false;
  if (paired == 0 && lost.empty())
    throw UserError(
        diagnostic(Code::E0544, fmt::format("{}: no row is a touch of the program", file),
                   "give the program that made the recording, or none: this recording has its own targets"));
  if (lost.empty()) return;
  const std::size_t all = lost.size();
  lost.resize(std::min<std::size_t>(all, 5));
  throw UserError(
      diagnostic(Code::E0544,
                 fmt::format("{}: {} rows are no touches of the program: {}{}", file, all, fmt::join(lost, ", "),
                             all > lost.size() ? ", ..." : ""),
                 fmt::format("the program has {} touches; rows are paired by feature and touch, counted from 1",
                             nominal.recording.rows.size())));
}

std::vector<std::string> columns_of(unsigned covariates) {
  std::vector<std::string> columns;
  for (const CovariateColumns& entry : covariate_columns())
    if (covariates & static_cast<unsigned>(entry.covariate))
      columns.insert(columns.end(), entry.columns.begin(), entry.columns.end());
  return columns;
}

}  // namespace abbe
