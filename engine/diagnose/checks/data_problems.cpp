// Recordings that no physics explains: another unit, swapped axes, normals the wrong way, rows twice. Each is
// recognised by what would mend it, and said instead of being diagnosed.
#include "engine/diagnose/checks/data_problems.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "engine/diagnose/checks/remedies.hpp"
#include "engine/diagnose/quantile.hpp"
#include "engine/recording/units.hpp"

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

/// One coordinate of the recorded positions in another unit, and the others as they should be.
void check_unit_of_each(const Recording& r, const std::string& file) {
  constexpr double kLeast_mm = 1, kAsMeant = 0.1;
  const auto along = [](int axis, const Vec3& v) {
    Vec3 out;
    out[axis] = v[axis];
    return out;
  };
  std::optional<std::pair<char, ForeignUnit>> foreign;
  int as_meant = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double recorded = size_of(r, [&](const RecordingRow& row) { return along(axis, row.position_mm); });
    const double meant = size_of(r, [&](const RecordingRow& row) { return along(axis, *row.target_mm); });
    const std::optional<ForeignUnit> unit = foreign_unit(recorded, meant);
    if (std::abs(recorded - meant) <= kAsMeant * meant) ++as_meant;
    if (unit && meant > kLeast_mm) foreign.emplace("xyz"[axis], *unit);
  }
  if (!foreign || as_meant < 2) return;
  const auto& [axis, unit] = *foreign;
  refuse(file, fmt::format("{} of the recorded positions is in {}, the targets in millimetres", axis, unit.name),
         fmt::format("multiply {} by {:g}", axis, unit.mm));
}

/// Positions and targets in different units, or both in one that this machine makes impossible.
void check_units(const Recording& r, const Machine& machine, const std::string& file) {
  constexpr double kLeast_mm = 1, kFar = 10, kNear = 2e-3;
  const double recorded = size_of(r, [](const RecordingRow& row) { return row.position_mm; });
  const double meant = size_of(r, [](const RecordingRow& row) { return *row.target_mm; });
  const double largest = std::max({machine[Axis::x].travel_mm, machine[Axis::y].travel_mm, machine[Axis::z].travel_mm});
  const bool targets_possible = meant > kLeast_mm && meant < largest;
  if (const auto unit = foreign_unit(recorded, meant); unit && targets_possible)
    refuse(file, fmt::format("the recorded positions are in {}, the targets in millimetres", unit->name),
           fmt::format("multiply x, y, z by {:g}", unit->mm));
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
  if (meant > 0 && meant < kLeast_mm && reach_of(r, machine) < kNear)
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
}

/// The middle of the ball on which all points lie; nothing where they lie on none, or on many.
std::optional<Vec3> middle_of_ball(const std::vector<Vec3>& points) {
  constexpr double kOn_mm = 0.02;  // targets come rounded
  constexpr double kFlat = 1e-4;
  const auto n = static_cast<Eigen::Index>(points.size());
  Vec3 mean;
  for (const Vec3& p : points) mean += (1 / double(n)) * p;
  Eigen::MatrixX4d a(n, 4);  // 2 c . p + k = p . p
  Eigen::VectorXd square(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vec3 p = points[static_cast<std::size_t>(i)] - mean;
    a.row(i) << 2 * p.x, 2 * p.y, 2 * p.z, 1;
    square(i) = dot(p, p);
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixX4d> qr(a);
  qr.setThreshold(kFlat);
  if (n < 5 || qr.rank() < 4) return std::nullopt;
  const Eigen::Vector4d found = qr.solve(square);
  const Vec3 middle = mean + Vec3{found(0), found(1), found(2)};
  const double radius = norm(points.front() - middle);
  const bool on_it = std::all_of(points.begin(), points.end(),
                                 [&](const Vec3& p) { return std::abs(norm(p - middle) - radius) < kOn_mm; });
  return on_it ? std::optional(middle) : std::nullopt;
}

/// Normals of a ball stand on it; where only those in another order do, their columns are exchanged.
void check_axes_of_normals(const Recording& r, const std::string& file) {
  constexpr double kStands = 0.99;  // cosine
  std::map<std::pair<int, std::string>, std::vector<const RecordingRow*>> features;
  for (const RecordingRow& row : r.rows) features[{row.setup, row.feature}].push_back(&row);
  std::vector<std::pair<Vec3, Vec3>> out_and_normal;
  for (const auto& [of, rows] : features) {
    std::vector<Vec3> targets;
    for (const RecordingRow* row : rows) targets.push_back(*row->target_mm);
    if (const std::optional<Vec3> middle = middle_of_ball(targets))
      for (const RecordingRow* row : rows) out_and_normal.emplace_back(unit(*row->target_mm - *middle), *row->normal);
  }
  const auto stand = [&](const std::array<int, 3>& order) {
    return std::all_of(out_and_normal.begin(), out_and_normal.end(), [&](const auto& pair) {
      return std::abs(dot(pair.first, unit(in_order(pair.second, order)))) > kStands;
    });
  };
  if (out_and_normal.empty() || stand({0, 1, 2})) return;
  for (int axis = 0; axis < 3; ++axis)
    if (std::all_of(out_and_normal.begin(), out_and_normal.end(), [&](const auto& pair) {
          return std::abs(dot(pair.first, unit(turned_round(pair.second, axis)))) > kStands;
        }))
      refuse(file,
             fmt::format("the sign of n{} is turned round: as it is, normals do not stand on the balls of the targets",
                         "xyz"[axis]),
             "correct the sign in the recording");
  for (const auto& o : kOrders)
    if (stand(o))
      refuse(file, "the axes of the normals are swapped: as they are, they do not stand on the balls of the targets",
             fmt::format("write the columns nx, ny, nz as they are now n{}, n{}, n{}", "xyz"[o[0]], "xyz"[o[1]],
                         "xyz"[o[2]]));
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

}  // namespace

void check_normals(const std::vector<const RecordingRow*>& rows, const Mat3& back, const std::string& file) {
  constexpr double kAgainst = 0.99;  // cosine
  std::vector<double> along;
  std::array<bool, 3> mended{true, true, true};
  std::size_t against = 0;
  for (const RecordingRow* row : rows) {
    if (!row->normal || !row->travel) continue;
    const Vec3 travel = row->travel_as_planned ? *row->travel : back * *row->travel;
    along.push_back(dot(*row->normal, travel));
    against += along.back() < -kAgainst;
    for (int axis = 0; axis < 3; ++axis)
      mended[static_cast<std::size_t>(axis)] &= dot(turned_round(*row->normal, axis), travel) < -kAgainst;
  }
  for (int axis = 0; axis < 3; ++axis)
    if (mended[static_cast<std::size_t>(axis)] && against < along.size())
      refuse(
          file,
          fmt::format(
              "the sign of n{} is turned round: only with the other sign does the machine travel against the normals",
              "xyz"[axis]),
          fmt::format("correct the sign of n{0}, or of a{0} where that is wrong", "xyz"[axis]));
  if (along.empty() || median(std::move(along)) < 0) return;
  refuse(
      file, "the machine travels along the normals, out of the material, not against them",
      "normals point out of the material and ax, ay, az in the direction of travel: turn round the columns that are the other way");
}

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
    const std::string which =
        fmt::format("'{}' touch {} (lines {} and {})", row.feature, row.touch, at->second->line, row.line);
    if (!(at->second->position_mm == row.position_mm))
      throw UserError(diagnostic(Code::E0713,
                                 fmt::format("{}: {} has two values at one time, in one setup and run", file, which),
                                 "give repeats another 'run', a part that was moved another 'setup'"));
    if (copies++ == 0) first = which;
  }
  if (copies > 0)
    messages.push_back(
        diagnostic(Code::W0702,
                   fmt::format("{}: {} rows stand there twice, the first is {}; they count once", file, copies, first),
                   "remove one of each pair"));
  return out;
}

void check_data(const Recording& r, const Machine& machine, const std::string& file) {
  const bool complete =
      std::all_of(r.rows.begin(), r.rows.end(), [](const RecordingRow& row) { return row.target_mm && row.normal; });
  if (!complete) return;  // recorded_touches() says what is missing
  check_units(r, machine, file);
  check_unit_of_each(r, file);
  check_head(r, file);
  check_axes_of_normals(r, file);
  const double gross = left_by(r, [](const RecordingRow& row) { return row.position_mm; });
  if (gross > kGross_mm) check_axes(r, file, gross);
  check_readings(r, file);  // against positions that are as they should be
}

}  // namespace abbe::diagnose
