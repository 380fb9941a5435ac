#include "engine/diagnose/baseline/round_surface.hpp"

#include <algorithm>
#include <cmath>

#include "engine/math/round_fit.hpp"
#include "engine/math/scatter.hpp"

namespace abbe::diagnose {

namespace {

/// The direction that all normals are square to, if there is only one.
std::optional<Vec3> axis_of(const std::vector<Vec3>& normals) {
  constexpr double kSquare = 1e-3, kSpread = 1e-2;  // of the mean square of a component
  const Eigen3<double> scatter = scatter_about(normals, {});
  if (scatter.value[2] > kSquare * kSquare || scatter.value[1] < kSpread) return std::nullopt;
  return least_direction(scatter);
}

Vec3 across(const Vec3& v, const std::optional<Vec3>& axis) { return axis ? v - dot(v, *axis) * *axis : v; }

}  // namespace

std::optional<RoundSurface> RoundSurface::through(const std::vector<Vec3>& targets, const std::vector<Vec3>& normals) {
  constexpr std::size_t kFewest = 5;
  constexpr double kOn_mm = 0.02;  // targets and normals come rounded
  constexpr double kSpread = 1e-4, kPoint_mm = 1e-3;
  if (targets.size() < kFewest) return std::nullopt;
  RoundSurface out;
  out.axis_ = axis_of(normals);
  std::vector<Vec3> seen;  // along the axis
  for (const Vec3& target : targets) seen.push_back(across(target, out.axis_));
  const RoundFit round = round_fit(seen, normals);
  if (round.spread < kSpread) return std::nullopt;
  if (std::abs(round.radius) < kPoint_mm) return std::nullopt;  // coordinates of one centre bend nowhere
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (norm(round.rest(seen[i], normals[i])) > kOn_mm) return std::nullopt;
  out.middle_ = round.centre, out.radius_mm_ = round.radius;
  return out;
}

double RoundSurface::bend_mm(const Vec3& target, const Vec3& place) const {
  constexpr double kFarthest = 0.25;
  const Vec3 arm = across(target, axis_) - middle_, off = across(place - target, axis_);
  const double radius = norm(arm), up = dot(off, arm) / radius, beside = norm(off - up / radius * arm);
  if (beside > kFarthest * radius) return 0;
  return std::copysign(norm(arm + off) - radius - up, radius_mm_);
}

}  // namespace abbe::diagnose
