#include "engine/diagnose/checks/normals.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/diagnose/checks/remedies.hpp"
#include "engine/diagnose/checks/unlogged_styli.hpp"
#include "engine/diagnose/model/decompositions.hpp"
#include "engine/diagnose/quantile.hpp"
#include "engine/run/recorded/from_program.hpp"

namespace abbe::diagnose {

namespace {

using TouchedRows = std::vector<const RecordingRow*>;

/// The middle of the ball on which all points lie; nothing where they lie on none, or on many.
std::optional<Vec3> middle_of_ball(const std::vector<Vec3>& points) {
  constexpr double kOn_mm = 0.02;  // targets come rounded
  constexpr double kFlat = 1e-4;
  const auto n = static_cast<Eigen::Index>(points.size());
  const Vec3 mean = mean_of(points);
  Matrix a(n, 4);  // 2 c . p + k = p . p
  Vector square(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vec3 p = points[i] - mean;
    a.row(i) << 2 * p.x, 2 * p.y, 2 * p.z, 1;
    square(i) = dot(p, p);
  }
  const Vector spread = spectrum(a.transpose() * a).values;
  if (n < 5 || spread(0) < kFlat * kFlat * spread(3)) return std::nullopt;
  const Vector found = least_squares(a, square);
  const Vec3 middle = mean + Vec3{found(0), found(1), found(2)};
  const double radius = norm(points.front() - middle);
  const bool on_it = std::all_of(points.begin(), points.end(),
                                 [&](const Vec3& p) { return std::abs(norm(p - middle) - radius) < kOn_mm; });
  return on_it ? std::optional(middle) : std::nullopt;
}

/// A touch of a ball, and which way is out of it there.
struct OnBall {
  Vec3 out;
  const RecordingRow* row;
};

/// The touches whose targets lie on balls. One ball may be touched in points that are features by themselves.
std::vector<OnBall> on_balls(const TouchedRows& rows) {
  constexpr int kPoints = 2;  // that a feature of its own has at the most
  std::map<std::pair<int, std::string>, int> touches;
  for (const RecordingRow* row : rows) ++touches[{row->setup, row->feature}];
  std::map<std::tuple<int, std::string, std::string>, TouchedRows> surfaces;
  for (const RecordingRow* row : rows) {
    const bool point = touches[{row->setup, row->feature}] <= kPoints;
    surfaces[{row->setup, point ? std::string{} : row->feature, point ? row->sensor.value_or("") : ""}].push_back(row);
  }
  std::vector<OnBall> out;
  for (const auto& [of, touched] : surfaces) {
    std::vector<Vec3> targets;
    for (const RecordingRow* row : touched) targets.push_back(*row->target_mm);
    if (const std::optional<Vec3> middle = middle_of_ball(targets))
      for (const RecordingRow* row : touched) out.push_back({unit(*row->target_mm - *middle), row});
  }
  return out;
}

/// Whether normals stand on their balls, out or in, once they are mended.
template <class Mend>
bool stand(const std::vector<OnBall>& touches, Mend mend) {
  constexpr double kStands = 0.99;  // cosine
  return std::all_of(touches.begin(), touches.end(),
                     [&](const OnBall& t) { return std::abs(dot(t.out, unit(mend(*t.row->normal)))) > kStands; });
}

Vec3 as_it_is(const Vec3& v) { return v; }

/// Cosine between a normal and the way back: what is more nearly along the surface does not touch it.
constexpr double kTouched = 0.1;

TouchedRows every_row(const Recording& r) {
  TouchedRows rows;
  for (const RecordingRow& row : r.rows) rows.push_back(&row);
  return rows;
}

/// "nb, na, nc": the columns of a vector in another order.
std::string columns(char of, const std::array<int, 3>& o) {
  return fmt::format("{0}{1}, {0}{2}, {0}{3}", of, "xyz"[o[0]], "xyz"[o[1]], "xyz"[o[2]]);
}

std::array<int, 3> inverse_of(const std::array<int, 3>& o) {
  std::array<int, 3> out{};
  for (int k = 0; k < 3; ++k) out[o[static_cast<std::size_t>(k)]] = k;
  return out;
}

/// Normals and directions of travel that agree once the axes of either are exchanged. `stand`: the normals stand on balls.
void check_orders(const TouchedRows& logged, const Mat3& back, bool normals_stand, const std::string& file) {
  constexpr double kAgainst = 0.99, kNearlyAll = 0.95;
  constexpr double kEnough = 3;
  const auto agree = [&](auto normal, auto travel) {
    return double(std::count_if(logged.begin(), logged.end(), [&](const RecordingRow* row) {
      return dot(normal(*row->normal), back * travel(*row->travel)) < -kAgainst;
    }));
  };
  const auto all = double(logged.size());
  if (all - agree(as_it_is, as_it_is) < std::max(kEnough, (1 - kNearlyAll) * all)) return;
  for (const auto& o : kOrders) {
    const std::array<int, 3> other = inverse_of(o);
    const auto ordered = [](const std::array<int, 3>& order) {
      return [&order](const Vec3& v) { return in_order(v, order); };
    };
    if (std::max(agree(ordered(o), as_it_is), agree(as_it_is, ordered(other))) < kNearlyAll * all) continue;
    const std::string travel = fmt::format("write the columns ax, ay, az as they are now {}", columns('a', other));
    refuse(
        file,
        "the axes of nx, ny, nz or of ax, ay, az are swapped: as they are, the machine does not travel against the normals",
        normals_stand
            ? fmt::format("the normals stand on the balls of the targets: {}", travel)
            : fmt::format("write the columns nx, ny, nz as they are now {}; or, where the normals are right, {}",
                          columns('n', o), travel));
  }
}

/// No touch is made along its normal, or along the surface.
void check_each_normal(const TouchedRows& rows, const Mat3& back, const std::string& file) {
  const RecordingRow* first = nullptr;
  double along = 0;
  std::map<std::string, int> touches;
  for (const RecordingRow* row : rows) {
    if (!row->normal || !row->travel) continue;
    const double cosine = dot(*row->normal, row->travel_as_planned ? *row->travel : back * *row->travel);
    if (cosine < -kTouched) continue;
    ++touches[row->feature];
    if (!first) first = row, along = cosine;
  }
  if (!first) return;
  std::vector<std::string> all;
  for (const auto& [feature, count] : touches) all.push_back(fmt::format("{} of '{}'", count, feature));
  refuse(
      file,
      fmt::format(
          "at touch {} of '{}' the machine travels {}{}", first->touch, first->feature,
          along > kTouched ? "along the normal, out of the material, not against it"
                           : "along the surface, which touches nothing",
          all.size() == 1 && touches.begin()->second == 1 ? "" : fmt::format(" (in all {})", fmt::join(all, ", "))),
      "normals point out of the material and ax, ay, az in the direction of travel: correct nx, ny, nz of these touches, or ax, ay, az where the normals are right");
}

}  // namespace

void check_normals_of_balls(const Recording& r, const std::string& file) {
  const std::vector<OnBall> touches = on_balls(every_row(r));
  if (touches.empty() || stand(touches, as_it_is)) return;
  for (int axis = 0; axis < 3; ++axis)
    if (stand(touches, [&](const Vec3& n) { return turned_round(n, axis); }))
      refuse(file,
             fmt::format("the sign of n{} is turned round: as it is, normals do not stand on the balls of the targets",
                         "xyz"[axis]),
             "correct the sign in the recording");
  for (const auto& o : kOrders)
    if (stand(touches, [&](const Vec3& n) { return in_order(n, o); }))
      refuse(file, "the axes of the normals are swapped: as they are, they do not stand on the balls of the targets",
             fmt::format("write the columns nx, ny, nz as they are now {}", columns('n', o)));
}

void doubt_hollow_balls(const Recording& r, const RecordedTouches& t, const std::string& file,
                        std::vector<Diagnostic>& messages) {
  constexpr double kBehind = -0.7, kRadial = 0.9999,
                   kInReach = -0.5;  // cosine to the stylus: where its shaft is, and where it is not yet
  if (lies_as_planned(r)) return;
  bool through = false, outside_in_reach = !r.in_part_frame;
  std::size_t inward = 0;
  std::map<const RecordingRow*, Vec3> to_head;
  for (const RecordedTouch& touch : t.touches) to_head[&r.rows[touch.row]] = touch.scene.stylus.to_head;
  const std::vector<OnBall> touches = on_balls(every_row(r));
  for (const auto& [out, row] : touches) {
    if (row->travel && !row->travel_as_planned) return;  // it says from which side
    inward += dot(out, unit(*row->normal)) < -kRadial;   // two rings of a bore lie on a ball, too
    const double along = dot(*row->normal, to_head[row]);
    through = through || along < kBehind;
    outside_in_reach = outside_in_reach && (row->sensor || row->head_a_deg) && -along > kInReach;
  }
  if (touches.empty() || inward < touches.size()) return;
  const std::string what = fmt::format("{}: nx, ny, nz point into the ball on which the targets lie", file);
  if (through && outside_in_reach)
    throw UserError(diagnostic(Code::E0701, what + ", and from inside the stylus would come through its material",
                               "normals point out of the material: turn round nx, ny, nz"));
  messages.push_back(diagnostic(Code::N0733, what + ": it is taken for a hollow one, touched from inside",
                                "if it is a ball, turn round nx, ny, nz"));
}

void leave_out_constant_travel(Recording& recording, const std::string& file, std::vector<Diagnostic>& messages) {
  std::map<int, std::vector<Vec3>> normals;
  for (const RecordingRow& row : recording.rows) {
    if (!row.travel || row.travel_as_planned || *row.travel != *recording.rows.front().travel) return;
    if (row.normal) normals[row.setup].push_back(*row.normal);
  }
  if (std::none_of(normals.begin(), normals.end(),
                   [](const auto& setup) { return least_along_the_best(setup.second) < kTouched; }))
    return;
  messages.push_back(diagnostic(
      Code::W0732,
      fmt::format(
          "{}: ax, ay, az are the same in all rows, and no one direction of travel touches all these surfaces: they are not used",
          file),
      "write the direction in which the machine travelled at each touch, or leave ax, ay, az out"));
  for (RecordingRow& row : recording.rows) row.travel.reset();
}

void check_normals(const std::vector<const RecordingRow*>& rows, const Mat3& back, const std::string& file) {
  constexpr double kAgainst = 0.99;  // cosine
  std::vector<double> along;
  std::array<bool, 3> mended{true, true, true};
  std::size_t against = 0;
  TouchedRows logged;
  for (const RecordingRow* row : rows) {
    if (!row->normal || !row->travel) continue;
    if (!row->travel_as_planned) logged.push_back(row);
    const Vec3 travel = row->travel_as_planned ? *row->travel : back * *row->travel;
    along.push_back(dot(*row->normal, travel));
    against += along.back() < -kAgainst;
    for (int axis = 0; axis < 3; ++axis) mended[axis] &= dot(turned_round(*row->normal, axis), travel) < -kAgainst;
  }
  if (along.empty()) return;
  const std::vector<OnBall> balls = on_balls(logged);
  const bool normals_stand = !balls.empty() && stand(balls, as_it_is);
  for (int axis = 0; axis < 3; ++axis)
    if (mended[axis] && against < along.size())
      refuse(
          file,
          fmt::format(
              "the sign of {}{} is turned round: only with the other sign does the machine travel against the normals",
              normals_stand ? 'a' : 'n', "xyz"[axis]),
          normals_stand ? "the normals stand on the balls of the targets: correct the sign in the recording"
                        : fmt::format("correct the sign of n{0}, or of a{0} where that is wrong", "xyz"[axis]));
  check_orders(logged, back, normals_stand, file);
  if (median(std::move(along)) < 0) return check_each_normal(rows, back, file);
  refuse(
      file, "the machine travels along the normals, out of the material, not against them",
      "normals point out of the material and ax, ay, az in the direction of travel: turn round the columns that are the other way");
}

}  // namespace abbe::diagnose
