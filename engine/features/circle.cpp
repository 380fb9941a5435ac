#include "engine/features/feature.hpp"
#include "engine/features/lane_fit.hpp"
#include "engine/features/minimax_fit.hpp"
#include "engine/features/nominal.hpp"
#include "engine/features/nominal_normal.hpp"
#include "engine/features/pattern.hpp"
#include "engine/features/points_fit.hpp"

namespace abbe {

/// Of circles: that of the best line.
template <>
Extended limit_cost<CircleProfile>(const Cloud& cloud, const Points<double>&) {
  return static_cast<Extended>(cloud.exact.size()) * cloud.spread.along[1] * cloud.spread.along[1];
}

namespace {

Outcome<Element> nominal_circle(const Arguments& arguments) {
  const Outcome<Vec3> along = direction(arguments);
  if (!along) return Outcome<Element>::failed(along.failure);
  const Outcome<double> size = radius(arguments, "diam");
  if (!size) return Outcome<Element>::failed(size.failure);
  return {{.point = location(arguments), .direction = along.value, .size = size.value}};
}

Outcome<PatternTouch> touch_circle(const Element& e, bool, int k, int n) {
  const Vec3 out = Across(e.direction).at(2 * kPi * k / n);
  return {{e.point + e.size * out, out}};
}

FeatArguments written_circle(const Element& e) { return {"CART", e.point, e.direction, 2 * e.size}; }

/// The points of a circle seen along its normal: what is left when their heights are taken away.
void flatten(Cloud& cloud, const Extended (&normal)[3]) {
  for (std::size_t i = 0; i < cloud.exact.size(); ++i) {
    auto& p = cloud.exact[i];
    const Extended h = p[0] * normal[0] + p[1] * normal[1] + p[2] * normal[2];
    for (int k = 0; k < 3; ++k) p[k] -= h * normal[k], cloud.rounded[i][k] = double(p[k]);
  }
  cloud.spread = spread_of_points(cloud.exact);
}

FitSolution fit_circle_points(const FitProblem& problem, Cloud cloud, const Element* start) {
  Extended n[3];
  for (int k = 0; k < 3; ++k) n[k] = problem.normal ? Extended((*problem.normal)[k]) : cloud.spread.direction[2][k];
  const Extended length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  for (Extended& component : n) component /= length;
  const Vec3 normal{double(n[0]), double(n[1]), double(n[2])};
  flatten(cloud, n);
  FitSolution bad;
  if ((bad.error = refusal({Shape::circle, {}, normal}, cloud))) return bad;
  return fit_revolution<CircleProfile>(
      cloud, start, [&](const auto& points, const auto& spread) { return circle_starts(points, spread, normal); });
}

}  // namespace

extern const FeatureKind circle_kind{
    .shape = Shape::circle,
    .word = "CIRCLE",
    .signature = "side:INNER|OUTER," ABBE_LOCATION "," ABBE_DIRECTION ",diam:length",
    .help = "a circle: centre, normal of its plane, diameter",
    .example = "F(C1)=FEAT/CIRCLE,INNER,CART,50,50,0,0,0,1,20",
    .source = "ISO 22093:2011, FEAT/CIRCLE; radial distances in the plane of the nominal normal",
    .nominal = nominal_circle,
    .written = written_circle,
    .normal = away_from_axis,
    .pattern = {.help = "evenly round, the first in the direction of x", .touch = touch_circle},
    .minimum_points = 3,
    .fit_lanes = fit_lanes_of<CircleProfile>,
    .refit = refit_by<CircleProfile>,
    .fit_points = fit_circle_points,
    .spread = 2,
    .fit_names = {.element = "circle", .point = "center", .direction = "normal", .size = "radius"},
};

}  // namespace abbe
