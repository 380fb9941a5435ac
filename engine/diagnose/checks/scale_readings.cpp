// Readings of the scales that are not those of the touches: in another unit, of other axes, or commanded. From the
// scales to the tip is one vector for each stylus and orientation, but for what the controller corrects.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/diagnose/checks/data_problems.hpp"
#include "engine/diagnose/checks/remedies.hpp"
#include "engine/diagnose/quantile.hpp"
#include "engine/recording/recording.hpp"
#include "engine/recording/units.hpp"

namespace abbe::diagnose {

namespace {

/// From one touch to the next.
struct Travel {
  Vec3 scales, tip;
};

/// Only between touches of one stylus in one orientation, because the readings jump where the head turns, and of one
/// setup, because `frame: part` does not tell that the part was moved; and that lie apart.
std::vector<Travel> travels(const Recording& r) {
  constexpr double kApart_mm = 1;
  using Mounted = std::tuple<int, std::optional<std::string>, std::optional<double>, std::optional<double>>;
  std::map<Mounted, const RecordingRow*> before;
  std::vector<Travel> out;
  for (const RecordingRow& row : r.rows) {
    if (!row.reading_mm) continue;
    const RecordingRow* last = std::exchange(before[{row.setup, row.sensor, row.head_a_deg, row.head_b_deg}], &row);
    if (last && norm(row.position_mm - last->position_mm) > kApart_mm)
      out.push_back({*row.reading_mm - *last->reading_mm, row.position_mm - last->position_mm});
  }
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

}  // namespace

void check_readings(const Recording& r, const std::string& file) {
  const std::vector<Travel> of_touches = travels(r);
  if (of_touches.empty()) return;
  check_unit(of_touches, file);
  if (r.in_part_frame) return;
  check_each_axis(of_touches, file);
  check_order(of_touches, file);
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
  std::map<std::tuple<std::string, std::optional<double>, std::optional<double>>, Tip> tips;
  for (const RecordingRow& row : recording.rows) {
    if (!row.reading_mm || !row.target_mm) return;
    Tip& tip = tips[{row.sensor.value_or(""), row.head_a_deg, row.head_b_deg}];
    tip.from_scales.push_back(row.position_mm - *row.reading_mm);
    tip.from_targets.push_back(row.position_mm - *row.target_mm);
  }
  double square = 0, left = 0;
  for (auto& [of, tip] : tips) {
    for (std::vector<Vec3>* const list : {&tip.from_scales, &tip.from_targets}) {
      Vec3 mean;
      for (const Vec3& v : *list) mean += v / double(list->size());
      for (Vec3& v : *list) v -= mean;
    }
    for (std::size_t i = 0; i < tip.from_scales.size(); ++i) {
      const Vec3 between = tip.from_scales[i] - tip.from_targets[i];
      square += dot(tip.from_scales[i], tip.from_scales[i]), left += dot(between, between);
    }
  }
  // Positions may be rounded where scales are not.
  const double step = common_step_mm(recording), rows = double(recording.rows.size()),
               rounded = 3 * step * step / 12 * rows;
  if (left >= kAlike * square || square <= 2 * rounded || square > kElsewhere_mm * kElsewhere_mm * rows) return;
  messages.push_back(diagnostic(
      Code::W0729,
      fmt::format("{}: enc_x, enc_y, enc_z do not hold by how much the touches miss their targets: they are not used",
                  file),
      "record what the scales read at each touch, not what was commanded"));
  for (RecordingRow& row : recording.rows) row.reading_mm.reset();
}

}  // namespace abbe::diagnose
