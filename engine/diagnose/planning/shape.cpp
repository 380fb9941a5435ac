#include "engine/diagnose/planning/shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/math/round_fit.hpp"
#include "engine/math/scatter.hpp"

namespace abbe::diagnose {

namespace {

constexpr double kRound_mm = 0.1;  // what may be left of a round feature

Eigen3<double> scatter(const std::vector<Vec3>& list) { return scatter_about(list, mean_of(list)); }

/// A circle or cylinder: its normals lie in one plane, and what the radius leaves of the points lies along its axis.
std::optional<DmisFeature> turned(const Touched& s) {
  const Eigen3<double> normals = scatter(s.normals);
  constexpr double kInPlane = 1e-6, kSides = 0.05, kLong_mm = 1, kThin_mm = 1e-3;
  if (normals.value[2] > kInPlane || normals.value[1] < kSides) return std::nullopt;
  const Vec3 e = least_direction(normals);
  const double up = std::abs(e.z) > 1e-9 ? e.z : e.x + e.y + e.z;
  const Vec3 axis = (up < 0 ? -1.0 : 1.0) * e;
  const RoundFit round = round_fit(s.points, s.normals);
  double low = 1e9, high = -1e9;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    const Vec3 left = round.rest(s.points[i], s.normals[i]);
    if (norm(perpendicular_part(left, axis)) > kRound_mm || std::abs(dot(s.normals[i], axis)) > kThin_mm)
      return std::nullopt;
    low = std::min(low, dot(left, axis)), high = std::max(high, dot(left, axis));
  }
  constexpr std::size_t kOfCircle = 3, kOfCylinder = 5;
  const bool circle = high - low < kThin_mm && s.points.size() >= kOfCircle,
             cylinder = high - low > kLong_mm && s.points.size() >= kOfCylinder;
  if (!circle && !cylinder) return std::nullopt;
  const std::string kind = circle ? "CIRCLE" : "CYLNDR";
  return DmisFeature{kind,
                     fmt::format("{},{},CART,{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f},{:.7f}", kind,
                                 round.radius < 0 ? "INNER" : "OUTER", round.centre.x, round.centre.y, round.centre.z,
                                 axis.x, axis.y, axis.z, 2 * std::abs(round.radius))};
}

}  // namespace

std::optional<Ball> ball_of(const Touched& s) {
  constexpr double kSides = 0.02;  // mean square of the normals across the direction in which they spread least
  constexpr std::size_t kTouches = 4;
  if (s.points.size() < kTouches || scatter(s.normals).value[2] < kSides) return std::nullopt;
  const RoundFit ball = round_fit(s.points, s.normals);
  for (std::size_t i = 0; i < s.points.size(); ++i)
    if (norm(ball.rest(s.points[i], s.normals[i])) > kRound_mm) return std::nullopt;
  return Ball{ball.centre, ball.radius};
}

bool is_face(const Touched& s) {
  constexpr double kParallel = 1e-8;
  return scatter(s.normals).value[0] < kParallel;
}

std::vector<std::size_t> widest_triangle(const std::vector<Vec3>& points) {
  constexpr double kApart_mm = 1;
  const auto farthest = [&](auto distance) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < points.size(); ++i)
      if (distance(points[i]) > distance(points[best])) best = i;
    return best;
  };
  const Vec3 middle = mean_of(points);
  const std::size_t a = farthest([&](const Vec3& p) { return norm(p - middle); });
  const std::size_t b = farthest([&](const Vec3& p) { return norm(p - points[a]); });
  if (norm(points[b] - points[a]) < kApart_mm) return {a};
  const Vec3 along = unit(points[b] - points[a]);
  const auto off = [&](const Vec3& p) { return norm(perpendicular_part(p - points[a], along)); };
  const std::size_t c = farthest(off);
  if (off(points[c]) < kApart_mm) return {a, b};
  return {a, b, c};
}

DmisFeature dmis_feature(const Touched& s) {
  const Vec3 p = mean_of(s.points), n = s.normals.front();
  const std::string at = fmt::format("CART,{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f}", p.x, p.y, p.z, n.x, n.y, n.z);
  if (s.points.size() == 1) return {"POINT", "POINT," + at};
  if (is_face(s) && widest_triangle(s.points).size() == 3) return {"PLANE", "PLANE," + at};
  if (const std::optional<Ball> b = ball_of(s))
    return {"SPHERE",
            fmt::format("SPHERE,{},CART,{:.6f},{:.6f},{:.6f},{:.7f}", b->radius_mm < 0 ? "INNER" : "OUTER", b->centre.x,
                        b->centre.y, b->centre.z, 2 * std::abs(b->radius_mm))};
  return turned(s).value_or(DmisFeature{"GSURF", "GSURF"});
}

std::string begin_measuring(const std::string& label, const DmisFeature& feature, std::size_t points) {
  return fmt::format("F({0})=FEAT/{1}\nMEAS/{2},F({0}),{3}\n", label, feature.definition, feature.kind, points);
}

std::string measure_point(const Vec3& p, const Vec3& n) {
  return fmt::format("PTMEAS/CART,{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f}\n", p.x, p.y, p.z, n.x, n.y, n.z);
}

}  // namespace abbe::diagnose
