#include "engine/run/recorded/from_program.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "engine/base/letter_case.hpp"
#include "engine/math/rigid_fit.hpp"
#include "engine/math/units.hpp"
#include "engine/run/part_frame.hpp"

namespace abbe {

namespace {

/// A row in part coordinates, in the machine coordinates of the program.
void carry(const Rigid& X_MD, RecordingRow& row) {
  row.position_mm = X_MD * row.position_mm;
  if (row.target_mm) row.target_mm = X_MD * *row.target_mm;
  for (std::optional<Vec3>* direction : {&row.normal, &row.travel})
    if (*direction) *direction = X_MD.R * **direction;
}

/// A touch of the program for each of a row's feature and number.
using Partners = std::map<std::pair<std::string, int>, std::size_t>;

/// How the targets that a file gives are turned from those of the program, by setup. A turn of less changes no direction of
/// travel that matters.
std::map<int, Mat3> turns_in_file(const Recording& recording, const MachineRecord& nominal, const Partners& partner) {
  constexpr double kLittle_deg = 1;
  std::map<int, std::pair<std::vector<Vec3>, std::vector<Vec3>>> targets;  // of the program, of the file
  for (const RecordingRow& row : recording.rows) {
    const auto found = partner.find({upper(row.feature), row.touch});
    if (found == partner.end() || !row.target_mm) continue;
    targets[row.setup].first.push_back(*nominal.recording.rows[found->second].target_mm);
    targets[row.setup].second.push_back(*row.target_mm);
  }
  std::map<int, Mat3> out;
  for (const auto& [setup, of] : targets)
    if (const auto X = rigid_fit(of.first, of.second); X && in_degrees(turn_rad(X->R)) > kLittle_deg) out[setup] = X->R;
  return out;
}

}  // namespace

bool lies_as_planned(const Recording& recording) {
  return std::all_of(recording.rows.begin(), recording.rows.end(),
                     [](const RecordingRow& row) { return row.on_part_mm && row.normal_on_part; });
}

void complete_from_program(Recording& recording, const MachineRecord& nominal, const std::string& file) {
  Partners partner;
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
  const std::map<int, Mat3> turned =
      recording.in_part_frame ? std::map<int, Mat3>{} : turns_in_file(recording, nominal, partner);
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
    if (const auto turn = turned.find(row.setup); row.target_mm && from.travel && turn != turned.end())
      from.travel = turn->second * *from.travel;
    row.target_as_planned = !row.target_mm && !row.normal, row.travel_as_planned = !row.travel;
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

}  // namespace abbe
