// The fit of a surface of revolution to points alone (FeatureKind::fit_points): down from many starts on a sample of the
// points, then from the best few on all of them, the last steps in extended precision. Refused is what several
// elements fit equally well, and what larger and larger ones fit ever better.
#pragma once

#include "engine/features/descend.hpp"
#include "engine/features/feature.hpp"
#include "engine/features/starts.hpp"

namespace abbe {

inline FitSolution no_fit(const char* code) {
  FitSolution solution;
  solution.error = fit_error(code);
  return solution;
}

template <class Profile>
FitSolution revolution_solution(const Cloud& cloud, const Placed<Extended>& s) {
  FitSolution solution;
  solution.element = element_of(Profile::kShape, s, cloud.mean);
  Extended ready[3] = {};
  Profile::prepare(s.size, ready);
  CloudRanges ranges;
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

inline Placed<Extended> extended(const Placed<double>& s) {
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
inline bool different(const Placed<Extended>& a, const Placed<Extended>& b, Extended extent) {
  const Extended cosine = a.axes[2][0] * b.axes[2][0] + a.axes[2][1] * b.axes[2][1] + a.axes[2][2] * b.axes[2][2];
  const bool tilted = std::fabs(cosine) < 1 - 1e-8L;
  return tilted || std::fabs(a.size[0] - b.size[0]) > 1e-4L * std::max(extent, a.size[0]);
}

/// Whether a sum of squares is the best one but for a share of it and the rounding of the coordinates.
inline bool rival(const Cloud& cloud, Extended cost, Extended best, Extended share) {
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
inline bool cheaper(const Descent& a, const Descent& b) { return a.cost < b.cost; }

/// Where the starts lead: on the sample from all of them, on all points from the best few. Best first.
template <class Profile>
std::vector<Descent> descents(const Cloud& cloud, const std::vector<Placed<double>>& list,
                              const Points<double>& sampled) {
  std::vector<Descent> reached;
  for (Placed<double> s : list) {
    const double cost = descend<Profile>(sampled, cloud.extent(), s, 80);
    if (std::isfinite(cost) && measurable<Profile>(s, cloud.extent())) reached.push_back({cost, s});
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

/// The sum of squares that ever larger radii come near to: that of the best plane. Where no minimum is below it, the
/// best element is infinitely large. Kinds for which it is another one specialise this.
template <class Profile>
Extended limit_cost(const Cloud& cloud, const Points<double>&) {
  return static_cast<Extended>(cloud.exact.size()) * cloud.spread.along[2] * cloud.spread.along[2];
}

/// `begin` gives the starts where there is none.
template <class Profile, class Begin>
FitSolution fit_revolution(const Cloud& cloud, const Element* start, Begin begin) {
  constexpr int kSample = 400;
  const Points<double> sampled = sample(cloud.rounded, kSample);
  const Starts list =
      start ? Starts{placed(Profile::kShape, *start, cloud.centre())} : Starts(begin(sampled, cloud.spread));
  const std::vector<Minimum> found = minima<Profile>(cloud, descents<Profile>(cloud, list, sampled));
  if (found.empty()) return no_fit("not_converged");
  const Minimum& best = found.front();
  if (rival(cloud, limit_cost<Profile>(cloud, sampled), best.cost, 1e-9L)) return no_fit("not_converged");
  for (const Minimum& other : found)
    if (rival(cloud, other.cost, best.cost, 1e-9L) && different(best.surface, other.surface, cloud.extent()))
      return no_fit("not_unique");
  if (Profile::kShape == Shape::cone && std::fabs(best.surface.size[1]) < 1e-9L) return no_fit("no_apex");
  return revolution_solution<Profile>(cloud, best.surface);
}

/// FeatureKind::fit_points of surfaces of revolution.
template <class Profile, Starts begin(const Points<double>&, const Spread<Extended>&)>
FitSolution fit_points_of(const FitProblem&, Cloud cloud, const Element* start) {
  return fit_revolution<Profile>(cloud, start, begin);
}

}  // namespace abbe
