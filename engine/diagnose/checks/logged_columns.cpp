#include "engine/diagnose/checks/logged_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "engine/diagnose/quantile.hpp"
#include "engine/math/units.hpp"
#include "engine/recording/columns.hpp"
#include "engine/recording/recording.hpp"
#include "engine/run/recorded/styli.hpp"
#include "engine/run/recorded/touch.hpp"

namespace abbe::diagnose {

namespace {

/// Where one file of a recording lacks a column.
struct Gaps {
  std::size_t rows = 0, empty = 0;
  const RecordingRow* first = nullptr;  ///< of the empty ones
};

/// Takes a column out where some rows have it and some do not.
template <class Value>
void leave_out(std::optional<Value> RecordingRow::*column, const std::string& name, Recording& recording,
               const std::string& file, std::vector<Diagnostic>& messages) {
  std::map<int, Gaps> files;
  std::size_t empty = 0;
  for (const RecordingRow& row : recording.rows) {
    Gaps& gaps = files[row.file];
    ++gaps.rows;
    if (row.*column) continue;
    if (gaps.empty++ == 0) gaps.first = &row;
    ++empty;
  }
  if (empty == 0 || empty == recording.rows.size()) return;
  std::vector<std::string> without, told;
  for (const auto& [k, gaps] : files) {
    if (gaps.empty == 0) continue;
    const std::string& which = file_of(recording, *gaps.first, file);
    if (gaps.empty == gaps.rows)
      without.push_back(which);
    else
      told.push_back(fmt::format("{}: {} is empty in {} of {} rows, first for '{}' touch {}", which, name, gaps.empty,
                                 gaps.rows, gaps.first->feature, gaps.first->touch));
  }
  if (!without.empty())
    told.insert(told.begin(), fmt::format("{}: {} is in no row, only in other files", fmt::join(without, ", "), name));
  messages.push_back(diagnostic(Code::W0722, fmt::format("{}; it is not used", fmt::join(told, "; ")),
                                without.empty() ? "fill it in, or leave those rows out"
                                                : "fill it in, or judge the files that have it by themselves"));
  for (RecordingRow& row : recording.rows) (row.*column).reset();
}

/// A column that every row has, has no gaps.
template <class Value>
void leave_out(Value RecordingRow::*, const std::string&, Recording&, const std::string&, std::vector<Diagnostic>&) {}

/// Of what other unit a number that is too large for degrees Celsius may be.
std::string help_of_hot(double value) {
  constexpr double kFreezing_F = 32, kPerKelvin = 1.8, kFreezing_K = 273.15, kLeast_K = 250;
  if (value > kLeast_K)
    return fmt::format("if these are kelvins, convert them: {:.1f} K are {:.1f} C", value, value - kFreezing_K);
  return fmt::format("if these are degrees Fahrenheit, convert them: {:.1f} F are {:.1f} C", value,
                     (value - kFreezing_F) / kPerKelvin);
}

/// Doubts a column of temperatures that reaches further than a measuring room does.
void doubt(std::optional<double> RecordingRow::*column, const std::string& name, const Recording& recording,
           const std::string& file, std::vector<Diagnostic>& messages) {
  constexpr double kCold_C = 5, kHot_C = 45;
  for (const RecordingRow& row : recording.rows) {
    const std::optional<double>& value = row.*column;
    if (!value || (*value > kCold_C && *value < kHot_C)) continue;
    messages.push_back(diagnostic(
        Code::W0724,
        fmt::format("{}: {} is {:.1f} degrees C for '{}' touch {}", file_of(recording, row, file), name, *value,
                    row.feature, row.touch),
        *value <= kCold_C ? "if the sensor was not read there, leave the field empty" : help_of_hot(*value)));
    return;
  }
}

/// What would make the usual interval of so short a one.
std::string help_of_slow_clock(double interval) {
  constexpr std::pair<std::string_view, double> kUnits_s[] = {{"minutes", 60}, {"hours", 3600}, {"days", 86400}};
  const auto off = [&](double unit) { return std::abs(std::log(interval * unit / kUsualInterval_s)); };
  const auto [name, unit] = *std::min_element(std::begin(kUnits_s), std::end(kUnits_s),
                                              [&](auto a, auto b) { return off(a.second) < off(b.second); });
  return fmt::format("if these are {}, convert them: {:.3g} {} are {:.3g} s", name, interval, name, unit * interval);
}

/// Doubts times from touch to touch.
void doubt_intervals(const Recording& recording, const std::string& file, std::vector<Diagnostic>& messages) {
  constexpr double kDay_s = 86400, kLong_s = 300, kShort_s = 0.25, kPause_s = 7 * kDay_s;
  std::vector<double> times, between;
  for (const RecordingRow& row : recording.rows)
    if (row.time_s) times.push_back(*row.time_s);
  std::sort(times.begin(), times.end());
  for (std::size_t i = 1; i < times.size(); ++i) between.push_back(times[i] - times[i - 1]);
  if (between.empty()) return;
  const double longest = *std::max_element(between.begin(), between.end()), usual = median(std::move(between));
  if (usual >= kLong_s)
    messages.push_back(diagnostic(
        Code::W0728,
        fmt::format("{}: by time_s, half of the touches come {:g} s or more after the one before", file, usual),
        fmt::format("if these are milliseconds, convert them: {:g} ms are {:g} s", usual, 1e-3 * usual)));
  else if (usual > 0 && usual < kShort_s)
    messages.push_back(diagnostic(
        Code::W0728,
        fmt::format("{}: by time_s, half of the touches come {:g} s or less after the one before", file, usual),
        help_of_slow_clock(usual)));
  if (longest >= kPause_s && usual < kLong_s)
    messages.push_back(diagnostic(
        Code::W0728, fmt::format("{}: by time_s, {:.0f} days pass between two touches", file, longest / kDay_s),
        "if some rows have the time of another clock, write the seconds since one start into all"));
}

}  // namespace

void doubt_temperatures(const Recording& recording, const std::string& file, std::vector<Diagnostic>& messages) {
  for (const RecordingColumn& column : recording_columns()) {
    const auto* const value = std::get_if<std::optional<double> RecordingRow::*>(&column.member);
    if (value && column.names[0].starts_with("temp_")) doubt(*value, name(column), recording, file, messages);
  }
}

void doubt_motion(const Recording& recording, const std::string& file, std::vector<Diagnostic>& messages) {
  constexpr double kSlow_mm_s = 0.02, kFast_mm_s = 100, kSecondsPerMinute = 60;
  constexpr double kWeak_mm_s2 = 1, kHard_mm_s2 = 5e4;
  const std::string kNotLogged = "no touch is made standing still: if it was not logged there, leave the field empty";
  const auto doubt = [&](std::optional<double> RecordingRow::*column, std::string_view name, double low, double high,
                         auto help) {
    const auto odd = std::find_if(recording.rows.begin(), recording.rows.end(), [&](const RecordingRow& row) {
      return row.*column && (*(row.*column) < low || *(row.*column) > high);
    });
    if (odd == recording.rows.end()) return;
    const double value = *((*odd).*column);
    messages.push_back(diagnostic(Code::W0728,
                                  fmt::format("{}: {} is {:g} for '{}' touch {}", file_of(recording, *odd, file), name,
                                              value, odd->feature, odd->touch),
                                  help(value)));
  };
  doubt(&RecordingRow::speed_mm_s, "speed_mm_s", kSlow_mm_s, kFast_mm_s, [&](double value) {
    if (value == 0) return kNotLogged;
    return value > kFast_mm_s
        ? fmt::format("if these are mm/min, convert them: {:g} mm/min are {:g} mm/s", value, value / kSecondsPerMinute)
        : fmt::format("if these are m/s, convert them: {:g} m/s are {:g} mm/s", value, 1e3 * value);
  });
  doubt(&RecordingRow::accel_mm_s2, "accel_mm_s2", kWeak_mm_s2, kHard_mm_s2, [&](double value) {
    if (value == 0) return kNotLogged;
    return value > kHard_mm_s2
        ? fmt::format("if these are um/s2, convert them: {:g} um/s2 are {:g} mm/s2", value, 1e-3 * value)
        : fmt::format("if these are m/s2, convert them: {:g} m/s2 are {:g} mm/s2", value, 1e3 * value);
  });
  doubt_intervals(recording, file, messages);
}

void leave_out_head_at_rest(Recording& recording, const Machine& machine, const std::string& file,
                            std::vector<Diagnostic>& messages) {
  const auto apart = [](double a_deg, double b_deg) { return std::abs(a_deg - b_deg) >= kReadBack_deg; };
  const RecordingRow& first = recording.rows.front();
  const NamedSensor* one = nullptr;
  bool turned = false;
  for (const RecordingRow& row : recording.rows) {
    if (!row.sensor || !row.head_a_deg || !row.head_b_deg) return;
    if (apart(*row.head_a_deg, *first.head_a_deg) || apart(*row.head_b_deg, *first.head_b_deg)) return;
    const auto found = machine.sensors.find(*row.sensor);
    if (found == machine.sensors.end()) return;
    const NamedSensor& stylus = found->second;
    if (!one) one = &stylus;
    turned = turned || apart(in_degrees(stylus.head_a_rad), in_degrees(one->head_a_rad)) ||
        apart(in_degrees(stylus.head_b_rad), in_degrees(one->head_b_rad));
  }
  if (!turned) return;
  messages.push_back(diagnostic(
      Code::W0736,
      fmt::format(
          "{}: head_A_deg and head_B_deg are {:g} and {:g} in all rows, and the styli are used in several orientations: those of the styli count",
          file, *first.head_a_deg, *first.head_b_deg),
      "write the angles at which the head stood at each touch, or leave the columns out"));
  for (RecordingRow& row : recording.rows) row.head_a_deg.reset(), row.head_b_deg.reset();
}

void leave_out_partly_logged(Recording& recording, const std::string& file, std::vector<Diagnostic>& messages) {
  for (const RecordingColumn& column : recording_columns())
    if (column.changes)
      std::visit([&](auto member) { leave_out(member, name(column), recording, file, messages); }, column.member);
}

}  // namespace abbe::diagnose
