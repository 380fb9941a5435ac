#include "engine/run/recorded/styli.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "engine/base/letter_case.hpp"
#include "engine/math/units.hpp"

namespace abbe {

namespace {

bool is_near(const std::optional<double>& a_deg, const std::optional<double>& b_deg) {
  return a_deg && b_deg ? std::abs(*a_deg - *b_deg) < kReadBack_deg : a_deg.has_value() == b_deg.has_value();
}

}  // namespace

RecordedStyli::RecordedStyli(const Recording& recording, const Machine& machine, const std::string& file)
    : recording_(recording), machine_(machine), file_(file) {
  machine_.head.present |= std::any_of(recording.rows.begin(), recording.rows.end(), [](const RecordingRow& row) {
    return row.head_a_deg.value_or(0) != 0 || row.head_b_deg.value_or(0) != 0;
  });
}

bool RecordedStyli::tells_stylus(const RecordingRow& row) const { return row.sensor || machine_.sensors.size() == 1; }

bool RecordedStyli::tells_head(const RecordingRow& row) const {
  return (row.head_a_deg && row.head_b_deg) || row.sensor || (tells_stylus(row) && !machine_.has_head());
}

const Sensor& RecordedStyli::of(const RecordingRow& row) {
  const std::string name = row.sensor.value_or("");
  std::deque<Known>& same_name = known_[upper(name)];
  for (const Known& known : same_name)
    if (is_near(known.a_deg, row.head_a_deg) && is_near(known.b_deg, row.head_b_deg)) return known.sensor;
  Sensor sensor = resolve(name, row);
  sensor.ordinal = stylus_ordinal(sensor, met_);
  met_.push_back(sensor);
  sensor.tip_ordinal = tips();
  if (static_cast<int>(names_.size()) < sensor.ordinal) names_.push_back(sensor.name);
  same_name.push_back({row.head_a_deg, row.head_b_deg, std::move(sensor)});
  return same_name.back().sensor;
}

Sensor RecordedStyli::resolve(const std::string& name, const RecordingRow& row) {
  plan::SensorDef def;
  def.label = name;
  def.from_machine_file = !name.empty();
  if (name.empty()) assume(row, def);
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

void RecordedStyli::require_sensor(const std::string& label, const RecordingRow& row) const {
  if (machine_.sensors.contains(label)) return;
  std::vector<std::string_view> names;
  for (const auto& [name, sensor] : machine_.sensors) names.push_back(name);
  const std::string near = nearest_word(label, names);
  throw UserError(diagnostic(
      Code::E0301,
      fmt::format("{}:{}: neither the recording nor machine '{}' says what sensor '{}' is",
                  file_of(recording_, row, file_), row.line, machine_.name, label),
      near.empty()
          ? fmt::format(
                "add the line '# sensor {}: head_deg A B tip_in_r_mm x y z diameter_mm d', or the sensor to the machine file",
                label)
          : fmt::format("did you mean '{}'?", near)));
}

/// A recording that does not name its stylus: the machine's only one, or a usual one, straight down.
void RecordedStyli::assume(const RecordingRow& row, plan::SensorDef& def) {
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
  if (!messages_.empty()) return;
  messages_.push_back(diagnostic(
      Code::W0541,
      fmt::format("{}: rows do not name their stylus, first '{}' touch {}: '{}' is assumed{}",
                  file_of(recording_, row, file_), row.feature, row.touch, def.label,
                  def.from_machine_file ? "" : ", 100 mm straight from the head, 2 mm ball"),
      known_.size() > 1 ? "fill in 'sensor' there, or leave those rows out: by it the other touches are told apart"
                        : "add the column 'sensor', and the sensor to the machine file"));
}

}  // namespace abbe
