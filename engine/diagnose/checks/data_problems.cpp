#include "engine/diagnose/checks/data_problems.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "engine/diagnose/checks/normals.hpp"
#include "engine/diagnose/checks/remedies.hpp"
#include "engine/diagnose/checks/scale_readings.hpp"
#include "engine/diagnose/quantile.hpp"
#include "engine/math/units.hpp"
#include "engine/recording/copies.hpp"
#include "engine/recording/units.hpp"
#include "engine/run/recorded/touch.hpp"

namespace abbe::diagnose {

namespace {

// median distance from the targets beyond which something other than errors is at work
constexpr double kGross_mm = 0.5;
constexpr double kMended = 0.05;  // share of it that a remedy may leave

template <class Remedy>
double left_by(const Recording& r, Remedy remedy) {
  std::vector<double> d;
  for (const RecordingRow& row : r.rows) d.push_back(norm(remedy(row) - *row.target_mm));
  return median(std::move(d));
}

/// How large the whole is, wherever it stands: half of the points lie no further from the middle. 0 for one
/// point touched again and again.
template <class Point>
double size_of(const Recording& r, Point point) {
  Vec3 middle;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> coordinates;
    for (const RecordingRow& row : r.rows) coordinates.push_back(point(row)[axis]);
    middle[axis] = median(std::move(coordinates));
  }
  std::vector<double> distance;
  for (const RecordingRow& row : r.rows) distance.push_back(norm(point(row) - middle));
  return median(std::move(distance));
}

/// How far out half of the targets lie, in travels of the machine's axes.
double reach_of(const Recording& r, const Machine& machine) {
  std::vector<double> reach;
  for (const RecordingRow& row : r.rows) {
    double most = 0;
    for (const Axis axis : {Axis::x, Axis::y, Axis::z})
      most = std::max(most, std::abs((*row.target_mm)[static_cast<int>(axis)]) / machine[axis].travel_mm);
    reach.push_back(most);
  }
  return median(std::move(reach));
}

Vec3 only_along(int axis, const Vec3& v) {
  Vec3 out;
  out[axis] = v[axis];
  return out;
}

/// How large the whole is along one axis, as it was recorded and as it was meant.
std::pair<double, double> sizes_along(const Recording& r, int axis) {
  return {size_of(r, [&](const RecordingRow& row) { return only_along(axis, row.position_mm); }),
          size_of(r, [&](const RecordingRow& row) { return only_along(axis, *row.target_mm); })};
}

bool is_as_meant(const Recording& r, int axis) {
  constexpr double kAsMeant = 0.1;
  const auto [recorded, meant] = sizes_along(r, axis);
  return std::abs(recorded - meant) <= kAsMeant * meant;
}

/// One coordinate of the recorded positions, or of the targets, in another unit, and the others as they should be.
void check_unit_of_each(const Recording& r, const std::string& file) {
  constexpr double kLeast_mm = 1;
  std::optional<std::pair<int, ForeignUnit>> foreign, too_large;
  int as_meant = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [recorded, meant] = sizes_along(r, axis);
    as_meant += is_as_meant(r, axis);
    if (const auto unit = foreign_unit(recorded, meant); unit && meant > kLeast_mm) foreign.emplace(axis, *unit);
    if (const auto unit = foreign_unit(meant, recorded); unit && recorded > kLeast_mm) too_large.emplace(axis, *unit);
  }
  if (as_meant < 2) return;
  if (foreign) {
    const auto& [of, in] = *foreign;
    refuse(file, fmt::format("{} of the recorded positions is in {}, the targets in millimetres", "xyz"[of], in.name),
           fmt::format("multiply {} by {:g}", "xyz"[of], in.mm));
  }
  if (!too_large) return;
  const auto& [axis, unit] = *too_large;
  const char name = "xyz"[axis];
  const char* const remedy = readings_agree(r, Places::targets, axis)
      ? "the scale readings agree with t{0}: divide {0} by {1:g}"
      : readings_agree(r, Places::positions, axis)
      ? "the scale readings agree with {0}: t{0} is in {2}, multiply it by {1:g}"
      : "divide {0} by {1:g}, or if t{0} is in {2}, multiply that";
  refuse(file, fmt::format("{0} of the recorded positions is {1:g} times t{0}", name, unit.mm),
         fmt::format(fmt::runtime(remedy), name, unit.mm, unit.name));
}

/// A recorded coordinate that is the same in all rows, where its targets are not.
void check_one_value(const Recording& r, const std::string& file) {
  constexpr double kApart_mm = 1;
  std::vector<std::string> same;
  bool others_as_meant = true;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [nearest, farthest] = std::minmax_element(
        r.rows.begin(), r.rows.end(),
        [&](const RecordingRow& a, const RecordingRow& b) { return (*a.target_mm)[axis] < (*b.target_mm)[axis]; });
    if ((*farthest->target_mm)[axis] - (*nearest->target_mm)[axis] < kApart_mm) continue;
    const double first = r.rows.front().position_mm[axis];
    if (std::all_of(r.rows.begin(), r.rows.end(),
                    [&](const RecordingRow& row) { return row.position_mm[axis] == first; }))
      same.push_back(std::string(1, "xyz"[axis]));
    else
      others_as_meant = others_as_meant && is_as_meant(r, axis);
  }
  // A part that stands turned may have a face along an axis: there the others are not as meant.
  if (same.empty() || !others_as_meant) return;
  refuse(file,
         fmt::format("{} of the recorded positions {} the same in all rows, and the targets are not",
                     fmt::join(same, ", "), same.size() > 1 ? "are" : "is"),
         "write the position of each touch");
}

/// Positions and targets in different units, or both in one that this machine makes impossible.
void check_units(const Recording& r, const Machine& machine, const std::string& file) {
  constexpr double kLeast_mm = 1, kLeastOfPart_mm = 0.1, kFar = 10, kClose = 2e-3;
  const double recorded = size_of(r, [](const RecordingRow& row) { return row.position_mm; });
  const double meant = size_of(r, [](const RecordingRow& row) { return *row.target_mm; });
  const double largest = std::max({machine[Axis::x].travel_mm, machine[Axis::y].travel_mm, machine[Axis::z].travel_mm});
  const bool targets_possible = meant > kLeast_mm && meant < largest;
  if (const auto unit = foreign_unit(recorded, meant); unit && targets_possible)
    refuse(file, fmt::format("the recorded positions are in {}, the targets in millimetres", unit->name),
           fmt::format("multiply x, y, z by {:g}", unit->mm));
  if (const auto unit = foreign_unit(meant, recorded); unit && readings_agree(r, Places::targets))
    refuse(file,
           fmt::format("the recorded positions are {:g} times the targets, and the scale readings agree with these",
                       unit->mm),
           fmt::format("divide x, y, z by {:g}", unit->mm));
  if (const auto unit = foreign_unit(meant, recorded))
    refuse(file, fmt::format("the targets are in {}, the recorded positions in millimetres", unit->name),
           fmt::format("multiply tx, ty, tz by {:g}", unit->mm));
  if (meant > 0 && reach_of(r, machine) > kFar)
    refuse(
        file,
        fmt::format(
            "positions and targets reach more than {:g} times as far as machine '{}' travels: they are in micrometres",
            kFar, machine.name),
        "multiply x, y, z, tx, ty, tz by 0.001");
  // Coordinates of the part begin somewhere at it, and it may be as small as a ball of a millimetre.
  const double least_mm = r.in_part_frame ? kLeastOfPart_mm : kLeast_mm;
  if (meant > 0 && meant < least_mm && reach_of(r, machine) < kClose)
    refuse(
        file,
        fmt::format(
            "half of the touches lie within {:.2g} mm, close to the machine's zero: positions and targets are in metres",
            meant),
        "multiply x, y, z, tx, ty, tz by 1000");
}

void check_axes(const Recording& r, const std::string& file, double gross) {
  for (const auto& o : kOrders)
    if (left_by(r, [&](const RecordingRow& row) { return in_order(row.position_mm, o); }) < kMended * gross)
      refuse(
          file, "the axes of the recorded positions are swapped",
          fmt::format("write the columns x, y, z as they are now {}, {}, {}", "xyz"[o[0]], "xyz"[o[1]], "xyz"[o[2]]));
  for (int axis = 0; axis < 3; ++axis)
    if (left_by(r, [&](const RecordingRow& row) { return turned_round(row.position_mm, axis); }) < kMended * gross)
      refuse(file, fmt::format("the sign of {} is turned round in the recorded positions", "xyz"[axis]),
             "correct the sign in the recording");
  if (left_by(r, [](const RecordingRow& row) { return -row.position_mm; }) < kMended * gross)
    refuse(file, "the signs of x, y and z are turned round in the recorded positions",
           "correct the signs in the recording");
}

/// The same touches, in two files: positions and targets of one of them may both be in another unit.
void check_units_of_files(const Recording& r) {
  constexpr std::size_t kFewest = 6;
  std::map<std::pair<std::string, int>, const RecordingRow*> first;  // by feature and touch
  std::map<std::pair<int, int>, std::pair<Recording, Recording>> pairs;
  for (const RecordingRow& row : r.rows) {
    const RecordingRow& before = *first.try_emplace({row.feature, row.touch}, &row).first->second;
    if (before.file == row.file) continue;
    auto& [earlier, later] = pairs[{before.file, row.file}];
    earlier.rows.push_back(before), later.rows.push_back(row);
  }
  const auto target = [](const RecordingRow& row) { return *row.target_mm; };
  const auto refuse_unit = [&](int file, int other, double written, double meant) {
    if (const auto unit = foreign_unit(written, meant))
      refuse(r.files[static_cast<std::size_t>(file)],
             fmt::format("positions and targets are in {}, those of the same touches in '{}' in millimetres",
                         unit->name, r.files[static_cast<std::size_t>(other)]),
             fmt::format("multiply x, y, z, tx, ty, tz by {:g}", unit->mm));
  };
  for (const auto& [files, rows] : pairs) {
    if (rows.first.rows.size() < kFewest) continue;
    const double earlier = size_of(rows.first, target), later = size_of(rows.second, target);
    refuse_unit(files.second, files.first, later, earlier);
    refuse_unit(files.first, files.second, earlier, later);
  }
}

/// Angles of the head in radians: none above a full turn, and each a usual one once it is taken for degrees.
void check_head(const Recording& r, const std::string& file) {
  constexpr double kStep_deg = 2.5, kReads_deg = 0.1;
  const auto usual = [](double deg) { return std::abs(deg - kStep_deg * std::round(deg / kStep_deg)) < kReads_deg; };
  bool small = true, as_degrees = true, as_radians = true;
  for (const RecordingRow& row : r.rows) {
    for (const std::optional<double>& angle : {row.head_a_deg, row.head_b_deg}) {
      if (!angle) continue;
      small = small && std::abs(*angle) < 2 * kPi;
      as_degrees = as_degrees && usual(*angle);
      as_radians = as_radians && usual(in_degrees(*angle));
    }
  }
  if (small && as_radians && !as_degrees)
    refuse(file, "the angles of the head are in radians", "multiply head_A_deg and head_B_deg by 57.29578");
}

/// Whole runs, or placements, that stand in the file twice.
void refuse_copied_runs(const Recording& r, const std::string& file) {
  constexpr std::size_t kFewest = 10;  // a few touches may come out alike by chance
  std::map<std::pair<int, int>, int> number;
  std::vector<std::pair<int, int>> setup_and_run;
  std::vector<const RecordingRow*> rows;
  std::vector<int> group;
  for (const RecordingRow& row : r.rows) {
    const auto [at, fresh] = number.emplace(std::pair(row.setup, row.run), static_cast<int>(number.size()));
    if (fresh) setup_and_run.push_back(at->first);
    rows.push_back(&row), group.push_back(at->second);
  }
  const std::optional<Copied> copied = copied_group(rows, group, kFewest);
  if (!copied) return;
  const auto called = [&](int k) {
    return fmt::format("run {} of setup {}", setup_and_run[static_cast<std::size_t>(k)].second,
                       setup_and_run[static_cast<std::size_t>(k)].first);
  };
  throw UserError(diagnostic(
      Code::E0713,
      fmt::format("{}: {} holds the same touches as {}, to the last digit of their positions: rows were copied", file,
                  called(copied->later), called(copied->earlier)),
      "keep each run once; a repeat has other values"));
}

}  // namespace

Recording without_copies(const Recording& recorded, const std::string& file, std::vector<Diagnostic>& messages) {
  std::map<std::tuple<std::string, int, int, int, std::string, std::optional<double>>, const RecordingRow*> seen;
  Recording out = recorded;
  out.rows.clear();
  std::size_t copies = 0;
  std::string first;
  for (const RecordingRow& row : recorded.rows) {
    const auto [at, fresh] =
        seen.emplace(std::tuple(row.feature, row.touch, row.setup, row.run, row.sensor.value_or(""), row.time_s), &row);
    if (fresh) {
      out.rows.push_back(row);
      continue;
    }
    const std::string which = fmt::format("'{}' touch {} ({} and {})", row.feature, row.touch,
                                          line_of(recorded, *at->second), line_of(recorded, row));
    if (!(at->second->position_mm == row.position_mm))
      throw UserError(diagnostic(Code::E0713,
                                 fmt::format("{}: {} has two values {}, in one setup and run", file, which,
                                             row.time_s ? "at one time" : "and no time"),
                                 "give repeats another 'run', a part that was moved another 'setup'"));
    if (copies++ == 0) first = which;
  }
  if (copies > 0)
    messages.push_back(
        diagnostic(Code::W0702,
                   fmt::format("{}: {} rows stand there twice, the first is {}; they count once", file, copies, first),
                   "remove one of each pair"));
  refuse_copied_runs(out, file);
  return out;
}

namespace {

void check_units_and_axes(const Recording& r, const Machine& machine, const std::string& file) {
  check_one_value(r, file);
  check_units(r, machine, file);
  check_unit_of_each(r, file);
  check_head(r, file);
  const double gross = left_by(r, [](const RecordingRow& row) { return row.position_mm; });
  if (gross > kGross_mm) check_axes(r, file, gross);
}

}  // namespace

void check_data(const Recording& r, const Machine& machine, const std::string& file) {
  constexpr std::size_t kFewest = 12;  // touches of a file that is judged by itself
  require_targets(r, file);
  std::map<int, Recording> of_file;
  for (const RecordingRow& row : r.rows) of_file[row.file].rows.push_back(row);
  for (auto& [k, one] : of_file) {
    if (of_file.size() < 2 || one.rows.size() < kFewest) continue;
    one.in_part_frame = r.in_part_frame, one.point = r.point;
    check_units_and_axes(one, machine, file_of(r, one.rows.front(), file));
  }
  check_units_of_files(r);
  check_units_and_axes(r, machine, file);
  check_normals_of_balls(r, file);
  check_readings(r, file);  // against positions that are as they should be
}

}  // namespace abbe::diagnose
