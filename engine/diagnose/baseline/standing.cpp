#include "engine/diagnose/baseline/standing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "engine/diagnose/baseline/round_surface.hpp"
#include "engine/diagnose/checks/most_agree.hpp"
#include "engine/diagnose/checks/normals.hpp"
#include "engine/diagnose/model/decompositions.hpp"
#include "engine/diagnose/quantile.hpp"
#include "engine/math/units.hpp"

namespace abbe::diagnose {

namespace {

/// A touch, and the surface that it was aimed at where that is a round one.
struct Aimed {
  const RecordingRow* row;
  std::optional<RoundSurface> round;

  const Vec3& target_mm() const { return *row->target_mm; }
  const Vec3& normal() const { return *row->normal; }
  /// What a touch that X carries there owes to where it lies beside its target.
  double bend_mm(const Rigid& X) const { return round ? round->bend_mm(target_mm(), X * row->position_mm) : 0; }
};
using Rows = std::vector<Aimed>;
constexpr int kUnknowns = 7;
using Square = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Motion = Eigen::Matrix<double, kUnknowns, 1>;  // shift, turn, and what all touches are too far out

/// What carries a setup to its targets.
struct Back {
  Rigid X;
  double out_mm = 0;  ///< that all touches lie too far out: a wrong tip
};

/// How far each touch lies beyond its target, once the part is carried back.
std::vector<double> beyond(const Rows& rows, const Back& back) {
  std::vector<double> r;
  for (const Aimed& a : rows)
    r.push_back(dot(a.normal(), back.X * a.row->position_mm - a.target_mm()) + a.bend_mm(back.X) - back.out_mm);
  return r;
}

double middle_size(std::vector<double> r) {
  for (double& x : r) x = std::abs(x);
  return median(std::move(r));
}

/// Beyond this, a residual among these is no error of a part, a machine or a placement, but a slip.
double most_of_a_part(std::vector<double> r) {
  constexpr double kLeast_mm = 1, kTimes = 10;
  return kLeast_mm + kTimes * middle_size(std::move(r));
}

/// The middle of the targets, and the largest distance from it.
std::pair<Vec3, double> extent_of(const Rows& rows) {
  Vec3 middle;
  double extent = 1;
  for (const Aimed& a : rows) middle += a.target_mm() / double(rows.size());
  for (const Aimed& a : rows) extent = std::max(extent, norm(a.target_mm() - middle));
  return {middle, extent};
}

/// Of the motions that differ by what no normal sees the one that turns least: the shift of a ball that was not
/// touched all around is also a shift with a turn about its middle.
Motion turning_least(const Motion& motion, const Matrix& unseen) {
  constexpr double kShift = 1e-3;  // of a turn: what nothing shows shifts nothing either
  if (unseen.cols() == 0) return motion;
  const Motion counts{{kShift, kShift, kShift, 1, 1, 1, 1}};
  return motion - unseen * least_squares(counts.asDiagonal() * unseen, Vector(counts.cwiseProduct(motion)));
}

/// The small motion that lessens the weighted sum of squares most: a shift, a turn about `middle` times
/// `extent`, and with `tip` a length along all normals. A touch turns the part with the arm of its target: where
/// it lies itself may be a gross error, which along the surface is no distance to mend.
Motion step(const Rows& rows, bool tip, const Vec3& middle, double extent, const std::vector<double>& r) {
  constexpr double kLeast_mm = 1e-6, kShare = 0.01, kUnseen = 1e-6;
  const double most = most_of_a_part(r);  // a row in micrometres would count for all others
  double floor = kLeast_mm;               // below this a residual counts by its square
  for (const double x : r) floor += kShare * std::min(std::abs(x), most) / double(r.size());
  Square a = Square::Zero();
  Motion b = Motion::Zero();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Vec3 n = rows[i].normal(), turn = cross((rows[i].target_mm() - middle) / extent, n);
    const Motion s{{n.x, n.y, n.z, turn.x, turn.y, turn.z, tip ? -1.0 : 0.0}};
    const double weight = 1 / std::max(floor, std::abs(r[i]));
    a += weight * s * s.transpose();
    b -= weight * r[i] * s;
  }
  const auto [seen, directions] = spectrum(a);
  Motion motion = Motion::Zero();
  int unseen = 0;  // the first so many, in rising order
  for (int k = 0; k < kUnknowns; ++k) {
    if (seen(k) > kUnseen * seen(kUnknowns - 1))
      motion += directions.col(k).dot(b) / seen(k) * directions.col(k);
    else
      unseen = k + 1;
  }
  return turning_least(motion, directions.leftCols(unseen));
}

Back refined(const Rows& rows, Back back, bool tip) {
  constexpr int kMostSteps = 50;
  constexpr double kSettled_mm = 1e-7;
  const auto [middle, extent] = extent_of(rows);
  for (int k = 0; k < kMostSteps; ++k) {
    const Motion m = step(rows, tip, middle, extent, beyond(rows, back));
    const Vec3 shift{m(0), m(1), m(2)}, turn = Vec3{m(3), m(4), m(5)} / extent;
    const Mat3 R = norm(turn) > 0 ? rotation(unit(turn), norm(turn)) : Mat3{};
    back = {Rigid{R, middle + shift - R * middle} * back.X, back.out_mm + m(6)};
    if (m.norm() < kSettled_mm) break;
  }
  return back;
}

/// From where the touches lie if they have strayed so far that small steps from their targets may not find the way.
Back placement_of(const Rows& rows) {
  constexpr double kStrayed_mm = 0.05;
  const Back near = refined(rows, {}, false);
  const double left = middle_size(beyond(rows, near));
  if (left < kStrayed_mm) return near;
  std::vector<Vec3> here, there;
  for (const Aimed& a : rows) here.push_back(a.row->position_mm), there.push_back(a.target_mm());
  const std::optional<Rigid> start = placement_of_most(std::move(here), std::move(there));
  if (!start) return near;
  const Back far = refined(rows, {*start}, false);
  return middle_size(beyond(rows, far)) < left / 2 ? far : near;
}

double angle_deg(const Mat3& R) { return in_degrees(turn_rad(R)); }

/// Whether a tip explains it with the part where it should be, and the placement only with the part turned
/// far: about the axis of a ring, which shortens all that is seen along its normals, and which no touch of a
/// ring can tell.
bool instead_of_a_turn(const Rows& rows, const Back& tip, const Back& back) {
  constexpr double kAlike_mm = 0.05, kFar_deg = 1, kShare = 0.1;
  return angle_deg(back.X.R) > kFar_deg && angle_deg(tip.X.R) < kShare * angle_deg(back.X.R) &&
      middle_size(beyond(rows, tip)) < middle_size(beyond(rows, back)) + kAlike_mm;
}

/// One length along all normals mends what no placement does: no physics of a touch is so large and so even.
void refuse_wrong_tip(const Rows& rows, const Back& back, double most_out_mm, const std::string& file) {
  constexpr double kMends = 0.2;
  Back with_tip = refined(rows, back, true);
  const Back in_place = refined(rows, {}, true);
  const bool turned = instead_of_a_turn(rows, in_place, back);
  if (turned) with_tip = in_place;
  const double out = with_tip.out_mm;
  if (std::abs(out) < most_out_mm ||
      (!turned && middle_size(beyond(rows, with_tip)) > kMends * middle_size(beyond(rows, back))))
    return;
  throw UserError(diagnostic(
      Code::E0701,
      fmt::format(
          "{}: every touch is {:.3f} mm too far {} along its normal: a tip radius, or a tip diameter, that was {}, or another tip than the file says",
          file, std::abs(out), out > 0 ? "out" : "in", out > 0 ? "added once too often" : "taken off once too often"),
      "check the line '# point: tip_centre|surface', the sign of the compensation, the tip, and whether targets are tip centres too; "
      "where it is the size of the features that is not known, say '# surfaces: unknown_size'"));
}

/// The touches of each setup that have a target and a normal. One ball may be touched in points that are features
/// by themselves. A tip of its own has a surface of its own, where it is the centres of tips that were recorded.
std::map<int, Rows> aimed_at(const std::vector<RecordingRow>& rows) {
  constexpr int kPoints = 2;  // that a feature of its own has at the most
  std::map<std::pair<int, std::string>, int> touches;
  for (const RecordingRow& row : rows) ++touches[{row.setup, row.feature}];
  const auto surface = [&](const RecordingRow& row) {
    const bool point = touches[{row.setup, row.feature}] <= kPoints;
    return std::tuple(row.setup, point ? std::string{} : row.feature, row.sensor.value_or(""));
  };
  struct Place {
    std::vector<Vec3> targets_mm, normals;
    std::optional<RoundSurface> round;
  };
  std::map<std::tuple<int, std::string, std::string>, Place> places;
  for (const RecordingRow& row : rows) {
    if (!row.target_mm || !row.normal) continue;
    Place& place = places[surface(row)];
    place.targets_mm.push_back(*row.target_mm), place.normals.push_back(*row.normal);
  }
  for (auto& [of, place] : places) place.round = RoundSurface::through(place.targets_mm, place.normals);
  std::map<int, Rows> out;
  for (const RecordingRow& row : rows)
    if (row.target_mm && row.normal) out[row.setup].push_back({&row, places[surface(row)].round});
  return out;
}

/// The rows of a setup are carried back to their targets.
void carry_to_targets(const Rigid& X, int setup, std::vector<RecordingRow>& rows) {
  for (RecordingRow& row : rows) {
    if (row.setup != setup) continue;
    row.position_mm = X * row.position_mm;
    if (row.travel && !row.travel_as_planned) row.travel = X.R * *row.travel;
  }
}

/// Targets of a setup that only the program tells are carried to where the part stood: there the machine measured it.
void carry_targets(const Rigid& X, int setup, std::vector<RecordingRow>& rows) {
  for (RecordingRow& row : rows) {
    if (row.setup != setup || !row.target_as_planned) continue;
    row.target_mm = X * *row.target_mm, row.normal = X.R * *row.normal;
    if (row.travel && row.travel_as_planned) row.travel = X.R * *row.travel;
  }
}

}  // namespace

Recording put_on_targets(const Recording& recorded, double most_out_mm, const std::string& file,
                         std::vector<Diagnostic>& messages) {
  constexpr double kNoticeable_mm = 0.05;  // up to this the linear placement is good to 0.1 um
  Recording out = recorded;
  for (const auto& [setup, rows] : aimed_at(recorded.rows)) {
    const Back placement = placement_of(rows);
    std::vector<const RecordingRow*> touched;
    for (const Aimed& a : rows) touched.push_back(a.row);
    check_normals(touched, placement.X.R, file);
    refuse_wrong_tip(rows, placement, most_out_mm, file);
    const Rigid& X = placement.X;
    const std::vector<double> before = beyond(rows, {}), after = beyond(rows, placement);
    // A row that is metres off is moved by the least turn, and says nothing of where the part stood.
    const double most = most_of_a_part(after);
    double change = 0;
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (std::abs(after[i]) < most) change = std::max(change, std::abs(after[i] - before[i]));
    if (change < kNoticeable_mm) continue;
    const Vec3 middle = extent_of(rows).first;
    const bool planned =
        std::all_of(touched.begin(), touched.end(), [](const RecordingRow* row) { return row->target_as_planned; });
    const Rigid there = planned ? inverse(X) : Rigid{};
    if (planned)
      carry_targets(there, setup, out.rows);
    else
      carry_to_targets(X, setup, out.rows);
    for (const Aimed& a : rows)
      out.rows[a.row - recorded.rows.data()].position_mm += a.bend_mm(X) * (there.R * a.normal());
    const std::string where = fmt::format(
        "{}: in setup {} the touches lie as if the part stood {:.2f} mm beside {} and turned by {:.3f} degrees; ", file,
        setup, norm(inverse(X) * middle - middle), planned ? "where its program has it" : "its targets",
        angle_deg(X.R));
    messages.push_back(
        planned
            ? diagnostic(Code::N0709, where + "its targets are carried there",
                         "errors of the machine are reckoned where it was touched: nothing is to be done")
            : diagnostic(
                  Code::N0709, where + "that is taken out",
                  "errors of the machine are reckoned at the targets: give targets where the part stood if that is far"));
  }
  return out;
}

}  // namespace abbe::diagnose
