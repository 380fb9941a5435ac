#include "engine/run/recorded/sensor_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <vector>

#include "engine/base/limits.hpp"
#include "engine/base/numbers.hpp"
#include "engine/math/units.hpp"

namespace abbe {

namespace {

constexpr std::string_view kKey = "sensor ";

/// A word of a sensor line and the numbers behind it, as in a machine file.
struct SensorWord {
  std::string_view name;
  std::size_t count;
  NumberRange range = kAnyNumber;
  bool required = false;
};
constexpr SensorWord kWords[] = {{"head_deg", 2, kTurn_deg},           {"tip_in_r_mm", 3, kCoordinate_mm, true},
                                 {"diameter_mm", 1, kLength_mm, true}, {"shaft_diameter_mm", 1, kPositive},
                                 {"young_GPa", 1, kYoung_GPa},         {"cte_ppm_per_K", 1, kCte_ppm_per_K}};

/// One sensor line of a recording, read word by word.
class SensorLine {
 public:
  SensorLine(const std::string& key, const std::string& value, const std::string& file)
      : key_(key), value_(value), file_(file) {
    std::istringstream in(value);
    for (std::string name; in >> name;) read(name, in);
    for (const SensorWord& word : kWords)
      if (word.required && !numbers_.contains(word.name)) refuse(fmt::format("{} is missing", word.name));
    if (number_or("shaft_diameter_mm", 0) > number_or("diameter_mm", 0)) refuse("the shaft is thicker than the ball");
  }

  /// Nothing when the line does not say it.
  std::optional<std::vector<double>> numbers(std::string_view name) const {
    const auto found = numbers_.find(name);
    return found == numbers_.end() ? std::nullopt : std::optional(found->second);
  }
  double number_or(std::string_view name, double otherwise) const {
    return numbers(name).value_or(std::vector{otherwise})[0];
  }

 private:
  void read(const std::string& name, std::istream& in) {
    const auto word =
        std::find_if(std::begin(kWords), std::end(kWords), [&](const SensorWord& w) { return w.name == name; });
    if (word == std::end(kWords)) refuse(fmt::format("'{}' stands where one of its words is expected", name));
    std::vector<double> numbers;
    for (std::string text; numbers.size() < word->count && in >> text;) {
      const std::optional<double> number = finite_number(text);
      if (!number || !word->range.holds(*number))
        refuse(fmt::format("'{}' of {} must be {}", text, name, word->range.words));
      numbers.push_back(*number);
    }
    if (numbers.size() < word->count) refuse(fmt::format("{} has {} of {} numbers", name, numbers.size(), word->count));
    if (!numbers_.emplace(word->name, std::move(numbers)).second) refuse(fmt::format("{} stands there twice", name));
  }

  [[noreturn]] void refuse(const std::string& why) const {
    throw UserError(diagnostic(Code::E0545,
                               fmt::format("{}: the line '# {}: {}' cannot be read: {}", file_, key_, value_, why),
                               "write head_deg A B tip_in_r_mm x y z diameter_mm d, numbers between blanks"));
  }

  const std::string &key_, &value_, &file_;
  std::map<std::string_view, std::vector<double>> numbers_;
};

/// What a line leaves out is as in a machine file.
NamedSensor sensor_of(const SensorLine& line) {
  NamedSensor s;
  const std::vector<double> head = line.numbers("head_deg").value_or(std::vector<double>{0, 0}),
                            tip = *line.numbers("tip_in_r_mm");
  s.head_a_rad = head[0] * kDegree;
  s.head_b_rad = head[1] * kDegree;
  s.tip_in_r_mm = {tip[0], tip[1], tip[2]};
  s.radius_mm = line.numbers("diameter_mm")->front() / 2;
  s.shaft_diameter_mm = line.number_or("shaft_diameter_mm", s.radius_mm);
  s.young_GPa = line.number_or("young_GPa", NamedSensor::kUsualYoung_GPa);
  s.cte_ppm_per_K = line.number_or("cte_ppm_per_K", NamedSensor::kUsualCte_ppm_per_K);
  return s;
}

/// As far as a recording writes them.
bool same_geometry(const NamedSensor& a, const NamedSensor& b) {
  constexpr double kWritten_mm = 1e-3, kWritten_rad = 1e-5;
  return norm(a.tip_in_r_mm - b.tip_in_r_mm) < kWritten_mm && std::abs(a.radius_mm - b.radius_mm) < kWritten_mm &&
      std::abs(a.head_a_rad - b.head_a_rad) < kWritten_rad && std::abs(a.head_b_rad - b.head_b_rad) < kWritten_rad;
}

/// As far as a new qualification may move a stylus.
bool same_stylus(const NamedSensor& a, const NamedSensor& b) {
  constexpr double kQualified_mm = 1, kQualified_rad = 1 * kDegree;
  return norm(a.tip_in_r_mm - b.tip_in_r_mm) < kQualified_mm && std::abs(a.radius_mm - b.radius_mm) < kQualified_mm &&
      std::abs(a.head_a_rad - b.head_a_rad) < kQualified_rad && std::abs(a.head_b_rad - b.head_b_rad) < kQualified_rad;
}

std::string place_of(const NamedSensor& s) {
  const Vec3& t = s.tip_in_r_mm;
  return fmt::format("{:g} {:g} {:g} mm with head angles {:g} {:g} and a ball of {:g} mm", t.x, t.y, t.z,
                     in_degrees(s.head_a_rad), in_degrees(s.head_b_rad), 2 * s.radius_mm);
}

}  // namespace

std::pair<std::string, std::string> sensor_line(const Sensor& s, const Machine& machine) {
  // Whatever mounted it: where the tip is, seen from the head's centre of the machine file.
  const Vec3 tip = transpose(s.R_WR) * (s.tip_from_mount_mm + Vec3{0, 0, machine.head.l_r_mm});
  return {
      std::string(kKey) + s.name,
      fmt::format(
          "head_deg {:.6g} {:.6g} tip_in_r_mm {:.6f} {:.6f} {:.6f} diameter_mm {:.6g} shaft_diameter_mm {:.6g} young_GPa {:.6g} cte_ppm_per_K {:.6g}",
          in_degrees(s.head_a_rad), in_degrees(s.head_b_rad), tip.x, tip.y, tip.z, 2 * s.radius_mm, s.shaft_diameter_mm,
          s.young_MPa / 1e3, 1e6 * s.cte_per_K)};
}

void add_recorded_sensors(const Recording& recording, Machine& machine, const std::string& file,
                          std::vector<Diagnostic>& messages) {
  std::map<std::string, NamedSensor, LabelOrder> described;
  for (const auto& [key, value] : recording.metadata) {
    if (!key.starts_with(kKey)) continue;
    const std::string name = key.substr(kKey.size());
    const NamedSensor recorded = sensor_of(SensorLine(key, value, file));
    const auto [first, is_first] = described.emplace(name, recorded);
    if (!is_first && !same_stylus(first->second, recorded))
      throw UserError(
          diagnostic(Code::E0707,
                     fmt::format("{}: '{}' is the name of two styli: the tip of one is at {}, of the other at {}", file,
                                 name, place_of(first->second), place_of(recorded)),
                     "give each stylus a name of its own, in the rows and in the lines '# sensor'"));
    if (!is_first) continue;
    if (const auto known = machine.sensors.find(name);
        known != machine.sensors.end() && !same_geometry(known->second, recorded))
      messages.push_back(diagnostic(
          Code::N0718,
          fmt::format(
              "{}: stylus '{}' is another one than the machine file has under that name: that of the recording counts",
              file, name),
          fmt::format("its tip is at {}, and at {} in the machine file", place_of(recorded), place_of(known->second))));
    machine.sensors.insert_or_assign(name, recorded);
  }
}

}  // namespace abbe
