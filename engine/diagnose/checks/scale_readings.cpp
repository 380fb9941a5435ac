#include "engine/diagnose/checks/scale_readings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/diagnose/checks/remedies.hpp"
#include "engine/diagnose/levels.hpp"
#include "engine/diagnose/quantile.hpp"
#include "engine/math/units.hpp"
#include "engine/recording/recording.hpp"
#include "engine/recording/units.hpp"

namespace abbe::diagnose {

namespace {

/// The stylus, in its orientation, that made a touch. Angles that were read back scatter by thousandths of a degree.
using Mounted = std::tuple<std::optional<std::string>, std::optional<long>, std::optional<long>>;

Mounted mounted(const RecordingRow& row) {
  constexpr double kPerDegree = 10;
  const auto rounded = [](const std::optional<double>& deg) {
    return deg ? std::optional(std::lround(kPerDegree * *deg)) : std::nullopt;
  };
  return {row.sensor, rounded(row.head_a_deg), rounded(row.head_b_deg)};
}

/// From one touch to the next.
struct Travel {
  Vec3 scales, tip;
};

struct Ends {
  const RecordingRow *from, *to;
};

/// Only between touches of one stylus in one orientation, because the readings jump where the head turns, and of one
/// setup, because `frame: part` does not tell that the part was moved.
std::vector<Ends> in_one_mounting(const Recording& r) {
  std::map<std::pair<int, Mounted>, const RecordingRow*> before;
  std::vector<Ends> out;
  for (const RecordingRow& row : r.rows) {
    if (!row.reading_mm) continue;
    const RecordingRow* last = std::exchange(before[{row.setup, mounted(row)}], &row);
    if (last) out.push_back({last, &row});
  }
  return out;
}

/// Whether the tip went about as far as it was sent. Where a position is wrong by metres, the readings are not.
bool goes_where_sent(const RecordingRow& from, const RecordingRow& to) {
  constexpr double kSlack_mm = 1, kShare = 0.5;
  if (!from.target_mm || !to.target_mm) return true;
  const double sent = norm(*to.target_mm - *from.target_mm);
  return std::abs(norm(to.position_mm - from.position_mm) - sent) <= kSlack_mm + kShare * sent;
}

std::vector<Travel> travels(const Recording& r, double apart_mm) {
  std::vector<Travel> out;
  for (const auto& [from, to] : in_one_mounting(r))
    if (norm(to->position_mm - from->position_mm) > apart_mm && goes_where_sent(*from, *to))
      out.push_back({*to->reading_mm - *from->reading_mm, to->position_mm - from->position_mm});
  return out;
}

/// The middle of what a remedy of the readings leaves between the two, in travels of the tip.
template <class Remedy>
double left_by(const std::vector<Travel>& travels, Remedy remedy) {
  std::vector<double> left;
  for (const Travel& t : travels) left.push_back(norm(remedy(t.scales) - t.tip) / norm(t.tip));
  return median(std::move(left));
}

void check_unit(const std::vector<Travel>& travels, const std::string& file) {
  std::vector<double> ratios;
  for (const Travel& t : travels) ratios.push_back(norm(t.scales) / norm(t.tip));
  if (const auto unit = foreign_unit(median(std::move(ratios)), 1))
    refuse(file, fmt::format("the scale readings are in {}, the recorded positions in millimetres", unit->name),
           fmt::format("multiply enc_x, enc_y, enc_z by {:g}", unit->mm));
}

/// One axis in another unit, or with the other sign.
void check_each_axis(const std::vector<Travel>& travels, const std::string& file) {
  constexpr double kApart_mm = 1, kAsWritten = 0.01;
  constexpr std::size_t kEnough = 3;
  for (int axis = 0; axis < 3; ++axis) {
    const char name = "xyz"[axis];
    std::vector<double> ratios;
    for (const Travel& t : travels)
      if (std::abs(t.tip[axis]) > kApart_mm) ratios.push_back(t.scales[axis] / t.tip[axis]);
    if (ratios.size() < kEnough) continue;
    const double ratio = median(std::move(ratios));
    if (std::abs(ratio + 1) < kAsWritten)
      refuse(file, fmt::format("the sign of enc_{} is turned round: the tip travels the other way", name),
             "correct the sign in the recording");
    const std::optional<ForeignUnit> unit = foreign_unit(ratio, 1);
    if (!unit) continue;
    refuse(file, fmt::format("enc_{} is in {}, the recorded positions in millimetres", name, unit->name),
           fmt::format("multiply enc_{} by {:g}", name, unit->mm));
  }
}

void check_order(const std::vector<Travel>& travels, const std::string& file) {
  // In travels: what other axes leave at least, and the right ones at most.
  constexpr double kOther = 0.1, kRight = 0.01;
  if (left_by(travels, [](const Vec3& v) { return v; }) < kOther) return;
  for (const auto& o : kOrders)
    if (left_by(travels, [&](const Vec3& v) { return in_order(v, o); }) < kRight)
      refuse(file, "the axes of the scale readings are swapped: the tip travels along others",
             fmt::format("write the columns enc_x, enc_y, enc_z as they are now enc_{}, enc_{}, enc_{}", "xyz"[o[0]],
                         "xyz"[o[1]], "xyz"[o[2]]));
}

/// The step of which all readings of an axis are multiples, wherever they begin; 0: it has one value, or none. Of touches
/// along that axis: across them a machine may stop where it was sent, at round places. Of a part in its own coordinates,
/// whose normals do not tell that, it is the step that all axes have in common.
double step_mm(const Recording& r, int axis) {
  constexpr double kAlong = 0.1;
  constexpr std::size_t kEnough = 6;  // what fewer have in common is where they happen to lie
  std::vector<double> from_first;
  std::optional<Vec3> first;
  for (const RecordingRow& row : r.rows) {
    if (!row.reading_mm || !row.normal) continue;
    if (!r.in_part_frame && std::abs((*row.normal)[axis]) < kAlong) continue;
    if (!first) first = row.reading_mm;
    for (int k = 0; k < 3; ++k)
      if (k == axis || r.in_part_frame) from_first.push_back((*row.reading_mm)[k] - (*first)[k]);
  }
  return from_first.size() < kEnough ? 0 : common_step_mm(from_first);
}

/// Why the readings of an axis do not tell where touches were; nothing where they do, or where the tip does not travel.
std::optional<std::string> strays(const std::vector<Travel>& travels, int axis) {
  constexpr double kAlong = 0.2, kFollows = 0.5;  // of the travel: a part that is not quite aligned has less beside it
  constexpr double kFew = 0.1;
  constexpr std::size_t kEnough = 3;
  std::size_t along = 0, astray = 0;
  bool moves = false;
  for (const Travel& t : travels) {
    moves = moves || t.scales[axis] != 0;
    if (std::abs(t.tip[axis]) < kAlong * norm(t.tip)) continue;
    ++along;
    astray += std::abs(t.scales[axis] - t.tip[axis]) > kFollows * std::abs(t.tip[axis]);
  }
  if (along < kEnough || double(astray) <= kFew * double(along)) return std::nullopt;
  const char name = "xyz"[axis];
  if (!moves) return fmt::format("enc_{0} is the same in all rows, and {0} is not", name);
  return fmt::format("enc_{0} does not follow {0}: from one touch to the next it goes elsewhere {1} times of {2}", name,
                     astray, along);
}

/// The same of a part in its own coordinates, of which only distances are those of the machine.
std::optional<std::string> strays(const std::vector<Travel>& travels) {
  constexpr double kFollows = 0.05, kFew = 0.1;
  constexpr std::size_t kEnough = 3;
  const auto astray = std::count_if(travels.begin(), travels.end(), [](const Travel& t) {
    return std::abs(norm(t.scales) - norm(t.tip)) > kFollows * norm(t.tip);
  });
  if (travels.size() < kEnough || double(astray) <= kFew * double(travels.size())) return std::nullopt;
  return fmt::format("enc_x, enc_y, enc_z do not go as far as x, y, z: {} times of {} from one touch to the next",
                     astray, travels.size());
}

/// The first travel on which the scales went elsewhere than the tip by far, as one decimal too few makes them. However the
/// coordinates of a part are turned, they go as far.
std::optional<std::string> far_off(const Recording& r) {
  constexpr double kFar_mm = 10, kShare = 0.5;
  for (const auto& [from, to] : in_one_mounting(r)) {
    const double tip = norm(to->position_mm - from->position_mm), scales = norm(*to->reading_mm - *from->reading_mm);
    if (!goes_where_sent(*from, *to) || std::abs(scales - tip) < kFar_mm + kShare * tip) continue;
    return fmt::format("from touch {} of '{}' ({}) to touch {} of '{}' ({}) the scales go {:.1f} mm, the tip {:.1f} mm",
                       from->touch, from->feature, line_of(r, *from), to->touch, to->feature, line_of(r, *to), scales,
                       tip);
  }
  return std::nullopt;
}

/// What is wrong with the readings, where they do not tell at which phase of its signal a scale was.
std::optional<std::string> no_phase(const Recording& r) {
  constexpr double kApart_mm = 0.1, kUsualPeriod_um = 20;
  const std::vector<Travel> of_touches = travels(r, kApart_mm);
  if (r.in_part_frame)
    if (std::optional<std::string> why = strays(of_touches)) return why;
  for (int axis = 0; axis < 3; ++axis) {
    const double step = step_mm(r, axis);
    if (!r.in_part_frame)
      if (std::optional<std::string> why = strays(of_touches, axis)) return why;
    if (kLeastStepsInPeriod * kUmPerMm * step > kUsualPeriod_um)
      return fmt::format("enc_{} is written in steps of {:g} um, and a scale has a signal period of some {:g} um",
                         "xyz"[axis], kUmPerMm * step, kUsualPeriod_um);
  }
  return far_off(r);
}

}  // namespace

void check_readings(const Recording& r, const std::string& file) {
  constexpr double kApart_mm = 1;
  const std::vector<Travel> of_touches = travels(r, kApart_mm);
  if (of_touches.empty()) return;
  check_unit(of_touches, file);
  if (r.in_part_frame) return;
  check_each_axis(of_touches, file);
  check_order(of_touches, file);
}

bool readings_agree(const Recording& r, Places places, std::optional<int> axis) {
  constexpr double kApart_mm = 1, kAgree = 0.02;
  if (axis && r.in_part_frame) return false;
  const auto length = [&](const Vec3& v) { return axis ? std::abs(v[*axis]) : norm(v); };
  std::vector<double> ratios;
  for (const auto& [from, to] : in_one_mounting(r)) {
    const double travel =
        length(places == Places::targets ? *to->target_mm - *from->target_mm : to->position_mm - from->position_mm);
    if (travel > kApart_mm) ratios.push_back(length(*to->reading_mm - *from->reading_mm) / travel);
  }
  return !ratios.empty() && std::abs(median(std::move(ratios)) - 1) < kAgree;
}

double reading_step_mm(const Recording& r) { return std::max({step_mm(r, 0), step_mm(r, 1), step_mm(r, 2)}); }

void leave_out_readings_without_phase(Recording& recording, const std::string& file,
                                      std::vector<Diagnostic>& messages) {
  const std::optional<std::string> why = no_phase(recording);
  if (!why) return;
  messages.push_back(diagnostic(
      Code::W0731, fmt::format("{}: {}. The scale readings are not used", file, *why),
      "record what all three scales read at each touch, to a micrometre or finer, or leave enc_x, enc_y, enc_z out"));
  for (RecordingRow& row : recording.rows) row.reading_mm.reset();
}

void leave_out_commanded_readings(Recording& recording, const std::string& file, std::vector<Diagnostic>& messages) {
  // Where the vector from the scales to the tip varies as touches deviate from their targets, the scales were not read at
  // the touch.
  constexpr double kAlike = 0.5;  // share of its squares that the deviations leave; 1 or more of scales that were read
  // By so much, positions are in another frame than the scales: the part stood elsewhere.
  constexpr double kElsewhere_mm = 0.02;
  if (recording.in_part_frame) return;
  struct Tip {
    std::vector<Vec3> from_scales, from_targets;
  };
  std::map<Mounted, Tip> tips;
  for (const RecordingRow& row : recording.rows) {
    if (!row.reading_mm || !row.target_mm) return;
    Tip& tip = tips[mounted(row)];
    tip.from_scales.push_back(row.position_mm - *row.reading_mm);
    tip.from_targets.push_back(row.position_mm - *row.target_mm);
  }
  Vec3 square, left;  // by axis: one scale may have been read and another not
  for (auto& [of, tip] : tips) {
    for (std::vector<Vec3>* const list : {&tip.from_scales, &tip.from_targets}) {
      const Vec3 mean = mean_of(*list);
      for (Vec3& v : *list) v -= mean;
    }
    for (std::size_t i = 0; i < tip.from_scales.size(); ++i)
      for (int axis = 0; axis < 3; ++axis)
        square[axis] += std::pow(tip.from_scales[i][axis], 2),
            left[axis] += std::pow(tip.from_scales[i][axis] - tip.from_targets[i][axis], 2);
  }
  // Positions may be rounded where scales are not.
  const double step = common_step_mm(recording), rows = double(recording.rows.size()),
               rounded = step * step / 12 * rows;
  std::vector<std::string> commanded;
  for (int axis = 0; axis < 3; ++axis)
    if (left[axis] < kAlike * square[axis] && square[axis] > 2 * rounded &&
        square[axis] <= kElsewhere_mm * kElsewhere_mm * rows)
      commanded.push_back(fmt::format("enc_{}", "xyz"[axis]));
  if (commanded.empty()) return;
  messages.push_back(diagnostic(
      Code::W0729,
      fmt::format("{}: {} {} not hold by how much the touches miss their targets: the scale readings are not used",
                  file, fmt::join(commanded, ", "), commanded.size() > 1 ? "do" : "does"),
      "record what the scales read at each touch, not what was commanded"));
  for (RecordingRow& row : recording.rows) row.reading_mm.reset();
}

void read_at_targets(Recording& recording) {
  using Stylus = std::tuple<std::optional<std::string>, std::optional<double>, std::optional<double>>;
  std::map<Stylus, std::vector<RecordingRow*>> touched;
  for (RecordingRow& row : recording.rows)
    if (row.reading_mm && row.target_mm) touched[{row.sensor, row.head_a_deg, row.head_b_deg}].push_back(&row);
  for (const auto& [stylus, rows] : touched)
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> beside;
      for (const RecordingRow* row : rows) beside.push_back((*row->reading_mm)[axis] - (*row->target_mm)[axis]);
      const double middle = std::round(median(std::move(beside)));
      for (RecordingRow* row : rows) (*row->reading_mm)[axis] = (*row->target_mm)[axis] + middle;
    }
}

}  // namespace abbe::diagnose
