#include "engine/features/fit.hpp"

#include <algorithm>

#include "engine/base/ids.hpp"
#include "engine/features/descend.hpp"
#include "engine/features/solve.hpp"
#include "engine/features/starts.hpp"

namespace abbe {
namespace {

constexpr int kSample = 400;

FitSolution failed(const char* code) {
  FitSolution solution;
  solution.error = fit_error(code);
  return solution;
}

/// Extremes and sum of squares of residuals, and extent along the direction.
struct Ranges {
  Extended low = INFINITY, high = -INFINITY, begin = INFINITY, end = -INFINITY, squares = 0;
  void add(Extended d, Extended h) {
    low = std::min(low, d), high = std::max(high, d);
    begin = std::min(begin, h), end = std::max(end, h);
    squares += d * d;
  }
  void report(FitSolution& solution, std::size_t n) const {
    solution.element.low = double(low), solution.element.high = double(high);
    solution.rms = double(std::sqrt(squares / static_cast<Extended>(n)));
    solution.form = double(high - low);
  }
};

FitSolution point_solution(const Cloud& cloud) {
  FitSolution solution;
  solution.element.point = {double(cloud.mean[0]), double(cloud.mean[1]), double(cloud.mean[2])};
  return solution;
}

FitSolution straight_solution(Shape shape, const Cloud& cloud) {
  FitSolution solution = point_solution(cloud);
  const Extended(&along)[3] = cloud.spread.direction[shape == Shape::line ? 0 : 2];
  solution.element.direction = {double(along[0]), double(along[1]), double(along[2])};
  Ranges ranges;
  for (const auto& p : cloud.exact) {
    const Extended h = p[0] * along[0] + p[1] * along[1] + p[2] * along[2];
    const Extended x = p[0] - h * along[0], y = p[1] - h * along[1], z = p[2] - h * along[2];
    const Extended across = std::sqrt(x * x + y * y + z * z);
    shape == Shape::line ? ranges.add(across, h) : ranges.add(h, across);
  }
  if (shape == Shape::line) ranges.low = -ranges.high;
  ranges.report(solution, cloud.exact.size());
  solution.element.begin = double(shape == Shape::line ? ranges.begin : -ranges.end);
  solution.element.end = double(ranges.end);
  return solution;
}

template <class Profile>
FitSolution revolution_solution(const Cloud& cloud, const Placed<Extended>& s) {
  FitSolution solution;
  solution.element = element_of(Profile::kShape, s, cloud.mean);
  Extended ready[3] = {};
  Profile::prepare(s.size, ready);
  Ranges ranges;
  for (const auto& p : cloud.exact) {
    Extended q[3];
    s.coordinates(p.data(), q);
    ranges.add(Profile::slopes(std::sqrt(q[0] * q[0] + q[1] * q[1]), q[2], ready).d, q[2]);
  }
  ranges.report(solution, cloud.exact.size());
  if (Profile::kShape != Shape::cylinder && Profile::kShape != Shape::cone) return solution;
  const bool turned = Profile::kShape == Shape::cone && s.size[1] < 0;
  solution.element.begin = double(turned ? -ranges.end : ranges.begin);
  solution.element.end = double(turned ? -ranges.begin : ranges.end);
  if (Profile::kShape != Shape::cone) return solution;
  const Extended back = s.size[0] / std::sin(s.size[1]);
  for (int k = 0; k < 3; ++k) solution.apex[k] = double(cloud.mean[k] + s.p[k] - back * s.axes[2][k]);
  return solution;
}

Placed<Extended> extended(const Placed<double>& s) {
  Placed<Extended> e;
  for (int i = 0; i < 3; ++i) {
    e.p[i] = s.p[i];
    for (int k = 0; k < 3; ++k) e.axes[i][k] = s.axes[i][k];
  }
  e.size[0] = s.size[0], e.size[1] = s.size[1];
  const Extended z[3] = {e.axes[2][0], e.axes[2][1], e.axes[2][2]};
  point_axis(e, z);  // unit and square in the longer format
  return e;
}

/// Two surfaces that no metrologist would call the same.
bool different(const Placed<Extended>& a, const Placed<Extended>& b, Extended extent) {
  const Extended cosine = a.axes[2][0] * b.axes[2][0] + a.axes[2][1] * b.axes[2][1] + a.axes[2][2] * b.axes[2][2];
  const bool tilted = std::fabs(cosine) < 1 - 1e-8L;
  return tilted || std::fabs(a.size[0] - b.size[0]) > 1e-4L * std::max(extent, a.size[0]);
}

/// Whether a sum of squares is the best one but for a share of it and the rounding of the coordinates.
bool rival(const Cloud& cloud, Extended cost, Extended best, Extended share) {
  const Extended rounding = cloud.negligible();
  return cost <= best * (1 + share) + static_cast<Extended>(cloud.exact.size()) * rounding * rounding;
}

struct Minimum {
  Extended cost;
  Placed<Extended> surface;
};

struct Descent {
  double cost;
  Placed<double> surface;
};
bool cheaper(const Descent& a, const Descent& b) { return a.cost < b.cost; }

/// Where the starts lead: on the sample from all of them, on all points from the best few. Best first.
template <class Profile>
std::vector<Descent> descents(const Cloud& cloud, const std::vector<Placed<double>>& list,
                              const Points<double>& sampled) {
  std::vector<Descent> reached;
  for (Placed<double> s : list) {
    const double cost = descend<Profile>(sampled, cloud.extent(), s, 80);
    if (std::isfinite(cost) && meaningful<Profile>(s)) reached.push_back({cost, s});
  }
  std::stable_sort(reached.begin(), reached.end(), cheaper);
  if (sampled.size() == cloud.rounded.size()) return reached;
  if (reached.size() > 3) reached.resize(3);
  for (Descent& d : reached) d.cost = descend<Profile>(cloud.rounded, cloud.extent(), d.surface, 40);
  std::stable_sort(reached.begin(), reached.end(), cheaper);
  return reached;
}

/// The best minimum and its rivals, those that fit (nearly) as well. Best first.
template <class Profile>
std::vector<Minimum> minima(const Cloud& cloud, const std::vector<Descent>& reached) {
  std::vector<Minimum> found;
  for (const Descent& d : reached) {
    if (found.size() == 3 || (!found.empty() && !rival(cloud, d.cost, found.front().cost, 1e-3L))) break;
    Placed<Extended> s = extended(d.surface);
    const bool known = std::any_of(found.begin(), found.end(),
                                   [&](const Minimum& m) { return !different(m.surface, s, cloud.extent()); });
    if (known) continue;
    if (polish<Profile>(cloud.exact, cloud.extent(), s)) found.push_back({sum_of_squares<Profile>(cloud.exact, s), s});
  }
  std::stable_sort(found.begin(), found.end(), [](const Minimum& a, const Minimum& b) { return a.cost < b.cost; });
  return found;
}

/// The sum of squares that ever larger radii come near to: that of the best plane, of a circle that of the
/// best line, of a torus also that of the best cylinder. Where no minimum is below it, the best element is
/// infinitely large.
Extended limit_cost(Shape shape, const Cloud& cloud, const Points<double>& sampled) {
  const Extended across = cloud.spread.along[shape == Shape::circle ? 1 : 2];
  const Extended flat = static_cast<Extended>(cloud.exact.size()) * across * across;
  if (shape != Shape::torus) return flat;
  const auto straight = minima<CylinderProfile>(
      cloud, descents<CylinderProfile>(cloud, starts(Shape::cylinder, sampled, cloud.spread, {}), sampled));
  return straight.empty() ? flat : std::min(flat, straight.front().cost);
}

template <class Profile>
FitSolution solve_revolution(const Cloud& cloud, const std::vector<Placed<double>>& list,
                             const Points<double>& sampled) {
  const std::vector<Minimum> found = minima<Profile>(cloud, descents<Profile>(cloud, list, sampled));
  if (found.empty()) return failed("not_converged");
  const Minimum& best = found.front();
  if (rival(cloud, limit_cost(Profile::kShape, cloud, sampled), best.cost, 1e-9L)) return failed("not_converged");
  for (const Minimum& other : found)
    if (rival(cloud, other.cost, best.cost, 1e-9L) && different(best.surface, other.surface, cloud.extent()))
      return failed("not_unique");
  if (Profile::kShape == Shape::cone && std::fabs(best.surface.size[1]) < 1e-9L) return failed("no_apex");
  return revolution_solution<Profile>(cloud, best.surface);
}

FitSolution solve(Shape shape, const Cloud& cloud, const std::vector<Placed<double>>& list,
                  const Points<double>& sampled) {
  switch (shape) {
    case Shape::circle: return solve_revolution<CircleProfile>(cloud, list, sampled);
    case Shape::cylinder: return solve_revolution<CylinderProfile>(cloud, list, sampled);
    case Shape::sphere: return solve_revolution<SphereProfile>(cloud, list, sampled);
    case Shape::cone: return solve_revolution<ConeProfile>(cloud, list, sampled);
    case Shape::torus: return solve_revolution<TorusProfile>(cloud, list, sampled);
    default: throw InternalError("not a surface of revolution");
  }
}

/// The sense of a direction that the points leave open: the component of the largest magnitude is positive.
FitSolution with_usual_sense(Shape shape, FitSolution solution) {
  const Vec3& d = solution.element.direction;
  const double ax = std::fabs(d.x), ay = std::fabs(d.y), az = std::fabs(d.z);
  const Vec3 leading = ax >= ay && ax >= az ? Vec3{1, 0, 0} : ay >= az ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  solution.element = turned_to(shape, solution.element, leading);
  return solution;
}

/// The points of a circle seen along its normal: what is left when their heights are taken away.
void flatten(Cloud& cloud, const Extended (&normal)[3]) {
  for (std::size_t i = 0; i < cloud.exact.size(); ++i) {
    auto& p = cloud.exact[i];
    const Extended h = p[0] * normal[0] + p[1] * normal[1] + p[2] * normal[2];
    for (int k = 0; k < 3; ++k) p[k] -= h * normal[k], cloud.rounded[i][k] = double(p[k]);
  }
  cloud.spread = spread_of_points(cloud.exact);
}

/// `begin` gives the starts once the cloud is known.
template <class Begin>
FitSolution fit(const FitProblem& problem, Begin begin) {
  FitSolution bad;
  if ((bad.error = refusal(problem))) return bad;
  Cloud cloud = centred(problem.points);
  if ((bad.error = refusal(problem, cloud))) return bad;
  const Shape shape = problem.shape;
  if (shape == Shape::point) return point_solution(cloud);
  if (shape == Shape::line || shape == Shape::plane) return with_usual_sense(shape, straight_solution(shape, cloud));
  std::optional<Vec3> normal;
  if (shape == Shape::circle) {
    Extended n[3];
    for (int k = 0; k < 3; ++k) n[k] = problem.normal ? Extended((*problem.normal)[k]) : cloud.spread.direction[2][k];
    const Extended length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (Extended& component : n) component /= length;
    normal = {double(n[0]), double(n[1]), double(n[2])};
    flatten(cloud, n);
    if ((bad.error = refusal({shape, {}, normal}, cloud))) return bad;
  }
  const Points<double> sampled = sample(cloud.rounded, kSample);
  const FitSolution solution = solve(shape, cloud, begin(cloud, sampled, normal), sampled);
  return problem.normal ? solution : with_usual_sense(shape, solution);
}

}  // namespace

FitSolution fit_points(const FitProblem& problem) {
  return fit(problem, [&](const Cloud& cloud, const Points<double>& sampled, const std::optional<Vec3>& normal) {
    return starts(problem.shape, sampled, cloud.spread, normal);
  });
}

FitSolution fit_points_from(const FitProblem& problem, const Element& start) {
  return fit(problem, [&](const Cloud& cloud, const Points<double>&, const std::optional<Vec3>&) {
    const Vec3 mean{double(cloud.mean[0]), double(cloud.mean[1]), double(cloud.mean[2])};
    return std::vector<Placed<double>>{placed(problem.shape, start, mean)};
  });
}

}  // namespace abbe
