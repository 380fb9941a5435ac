#include "engine/features/cloud.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/ids.hpp"
#include "engine/features/feature.hpp"
#include "engine/features/solve.hpp"

namespace abbe {
namespace {

struct Reason {
  const char *code, *text;
};
constexpr Reason kReasons[] = {
    {"bad_normal", "the prescribed normal has no length or is not finite"},
    {"coplanar_points", "all points lie in one plane, which fits a whole family of such elements equally well"},
    {"collinear_points", "all points lie on one line"},
    {"identical_points", "all points are identical"},
    {"no_apex", "the points lie on a cylinder: the best cone has no apex"},
    {"not_converged", "no least-squares minimum was found: the points do not have the form of the element"},
    {"not_finite", "a coordinate is not a finite number"},
    {"not_unique", "different elements fit the points equally well"},
    {"too_few_points", "there are fewer different points than the element needs"},
};

bool zero(const Vec3& p) { return p.x == 0 && p.y == 0 && p.z == 0; }
bool finite(const Vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

int count_distinct(const std::vector<Vec3>& points) {
  std::vector<std::array<double, 3>> sorted;
  for (const Vec3& p : points) sorted.push_back({p.x, p.y, p.z});
  std::sort(sorted.begin(), sorted.end());
  return static_cast<int>(std::unique(sorted.begin(), sorted.end()) - sorted.begin());
}

}  // namespace

const char* reason_of(std::string_view code) {
  for (const Reason& reason : kReasons)
    if (reason.code == code) return reason.text;
  throw InternalError("a FitError without a text");
}

FitError fit_error(const char* code) { return {code, reason_of(code)}; }

Spread<Extended> spread_of_points(const Points<Extended>& centred) {
  Spread<Extended> spread{{}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int pass = 0; pass < 2; ++pass) {
    Extended products[3][3] = {};
    const auto frame = spread.direction;
    for (const auto& p : centred) {
      Extended q[3];
      for (int i = 0; i < 3; ++i) q[i] = frame[i][0] * p[0] + frame[i][1] * p[1] + frame[i][2] * p[2];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) products[i][j] += q[i] * q[j];
    }
    const Spread<Extended> turned = spread_of(products, static_cast<int>(centred.size()));
    Spread<Extended> next = turned;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) {
        next.direction[i][k] = 0;
        for (int j = 0; j < 3; ++j) next.direction[i][k] += turned.direction[i][j] * frame[j][k];
      }
    spread = next;
  }
  return spread;
}

Cloud centred(const std::vector<Vec3>& points) {
  Cloud cloud;
  const auto n = static_cast<Extended>(points.size());
  for (int k = 0; k < 3; ++k) {
    for (const Vec3& p : points) cloud.mean[k] += Extended(p[k]) - points[0][k];
    cloud.mean[k] = points[0][k] + cloud.mean[k] / n;
  }
  for (const Vec3& p : points) {
    std::array<Extended, 3> exact{};
    for (int k = 0; k < 3; ++k) {
      exact[k] = p[k] - cloud.mean[k];
      cloud.largest_coordinate = std::max(cloud.largest_coordinate, std::fabs(p[k]));
    }
    cloud.exact.push_back(exact);
    cloud.rounded.push_back({double(exact[0]), double(exact[1]), double(exact[2])});
  }
  cloud.spread = spread_of_points(cloud.exact);
  return cloud;
}

std::optional<FitError> refusal(const FitProblem& problem) {
  if (problem.normal && (!finite(*problem.normal) || zero(*problem.normal))) return fit_error("bad_normal");
  if (!std::all_of(problem.points.begin(), problem.points.end(), finite)) return fit_error("not_finite");
  const int needed = feature_kind(problem.shape).minimum_points;
  if (static_cast<int>(problem.points.size()) < needed) return fit_error("too_few_points");
  const int distinct = count_distinct(problem.points);
  if (distinct == 1 && needed > 1) return fit_error("identical_points");
  if (distinct < needed) return fit_error("too_few_points");
  return std::nullopt;
}

std::optional<FitError> refusal(const FitProblem& problem, const Cloud& cloud) {
  const int needed = feature_kind(problem.shape).spread;
  const auto& along = cloud.spread.along;
  const double negligible = cloud.negligible();
  if (needed == 0) return std::nullopt;
  if (along[0] <= negligible) return fit_error("identical_points");
  if (needed > 1 && along[1] <= negligible) return fit_error("collinear_points");
  if (needed > 2 && along[2] <= negligible) return fit_error("coplanar_points");
  // Of a line or a plane the last of these directions must also stand out from the next.
  if (needed < 3 && !problem.normal && along[needed - 1] - along[needed] <= negligible) return fit_error("not_unique");
  return std::nullopt;
}

}  // namespace abbe
