// Recordings that no physics explains: another unit, swapped axes, a tip radius that was added or forgotten, rows twice. Each is
// recognised by what would mend it, and said instead of being diagnosed.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "engine/diagnose/case.hpp"
#include "engine/diagnose/median.hpp"

namespace abbe::diagnose {

namespace {

constexpr double kGross_mm = 0.5;      // median distance from the targets beyond which something other than errors is at work
constexpr double kMends = 0.05;        // share of it that a remedy may leave

template <class Remedy>
double left_by(const Recording& r, Remedy remedy) {
  std::vector<double> d;
  for (const RecordingRow& row : r.rows) d.push_back(norm(remedy(row) - *row.target_mm));
  return median(std::move(d));
}

[[noreturn]] void refuse(const std::string& file, std::string what, std::string help) {
  throw UserError(diagnostic(Code::E0701, fmt::format("{}: {}", file, what), std::move(help)));
}

void check_units(const Recording& r, const std::string& file, double gross) {
  const std::pair<double, const char*> units[] = {{1000, "metres"}, {1e-3, "micrometres"}, {25.4, "inches"}};
  for (const auto& [factor, word] : units)
    if (left_by(r, [f = factor](const RecordingRow& row) { return f * row.position_mm; }) < kMends * gross)
      refuse(file, fmt::format("the recorded positions are in {}, the targets in millimetres", word),
             fmt::format("multiply x, y, z by {:g}", factor));
}

void check_axes(const Recording& r, const std::string& file, double gross) {
  constexpr std::array<std::array<int, 3>, 5> orders = {{{1, 0, 2}, {2, 1, 0}, {0, 2, 1}, {1, 2, 0}, {2, 0, 1}}};
  for (const auto& o : orders)
    if (left_by(r, [&](const RecordingRow& row) { return Vec3{row.position_mm[o[0]], row.position_mm[o[1]], row.position_mm[o[2]]}; }) < kMends * gross)
      refuse(file, "the axes of the recorded positions are swapped", fmt::format("write the columns x, y, z as they are now {}, {}, {}", "xyz"[o[0]], "xyz"[o[1]], "xyz"[o[2]]));
  for (int axis = 0; axis < 3; ++axis)
    if (left_by(r, [&](const RecordingRow& row) { Vec3 p = row.position_mm; p[axis] = -p[axis]; return p; }) < kMends * gross)
      refuse(file, fmt::format("the sign of {} is turned round in the recorded positions", "xyz"[axis]), "correct the sign in the recording");
}

/// All touches are off by one length along their normals.
void check_radius(const Recording& r, const std::string& file) {
  std::vector<double> along, deviation;
  for (const RecordingRow& row : r.rows) along.push_back(dot(*row.normal, row.position_mm - *row.target_mm));
  const double middle = median(along);
  for (const double a : along) deviation.push_back(std::abs(a - middle));
  std::vector<double> normals;
  for (const RecordingRow& row : r.rows) normals.push_back(dot(*row.normal, *r.rows.front().normal));
  const bool one_way = *std::min_element(normals.begin(), normals.end()) > 0.9;   // then it may be the place of the part
  if (std::abs(middle) < kGross_mm / 2 || median(deviation) > 0.02 * std::abs(middle) || one_way) return;
  refuse(file, fmt::format("every touch is {:.3f} mm too far {} along its normal: a tip radius, or a tip diameter, that was {}", std::abs(middle),
                           middle > 0 ? "out" : "in", middle > 0 ? "added once too often" : "taken off once too often"),
         "check the line '# point: tip_centre|surface', the sign of the compensation, and whether targets are tip centres too");
}

/// A machine travels against the normal that it touches.
void check_normals(const Recording& r, const std::string& file) {
  std::vector<double> along;
  for (const RecordingRow& row : r.rows)
    if (row.normal && row.travel) along.push_back(dot(*row.normal, *row.travel));
  if (along.empty() || median(std::move(along)) < 0) return;
  refuse(file, "the machine travels along the normals, out of the material, not against them",
         "normals point out of the material and ax, ay, az in the direction of travel: turn round the columns that are the other way");
}

void find_duplicates(const Recording& r, const std::string& file, std::vector<Diagnostic>& messages) {
  std::map<std::tuple<std::string, int, int, int, std::string>, const RecordingRow*> seen;
  int twice = 0;
  std::string first;
  for (const RecordingRow& row : r.rows) {
    const auto [at, fresh] = seen.emplace(std::tuple(row.feature, row.touch, row.setup, row.run, row.sensor.value_or("")), &row);
    if (fresh || !(at->second->position_mm == row.position_mm) || at->second->time_s != row.time_s) continue;
    if (twice++ == 0) first = fmt::format("'{}' touch {} (lines {} and {})", row.feature, row.touch, at->second->line, row.line);
  }
  if (twice > 0)
    messages.push_back(diagnostic(Code::W0702, fmt::format("{}: {} rows stand there twice, the first is {}", file, twice, first),
                                  "remove one of each pair"));
}

}  // namespace

void check_data(const Recording& r, const std::string& file, std::vector<Diagnostic>& messages) {
  find_duplicates(r, file, messages);
  const bool complete = std::all_of(r.rows.begin(), r.rows.end(), [](const RecordingRow& row) { return row.target_mm && row.normal; });
  if (!complete) return;  // recorded_touches() says what is missing
  check_normals(r, file);
  const double gross = left_by(r, [](const RecordingRow& row) { return row.position_mm; });
  if (gross < kGross_mm) return;
  check_units(r, file, gross);
  check_axes(r, file, gross);
  check_radius(r, file);
}

}  // namespace abbe::diagnose
