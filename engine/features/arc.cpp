#include <cmath>
#include <utility>

#include "engine/features/cloud.hpp"
#include "engine/features/feature.hpp"
#include "engine/features/lane_fit.hpp"
#include "engine/features/minimax_fit.hpp"
#include "engine/features/nominal.hpp"
#include "engine/features/nominal_normal.hpp"
#include "engine/features/pattern.hpp"
#include "engine/math/units.hpp"

namespace abbe {

extern const FeatureKind circle_kind;

namespace {

/// The direction of the start angle: from (is, js, ks), else from the x axis, across the normal.
Vec3 start_of(const Arguments& arguments, const Vec3& normal) {
  const Vec3 zero{arguments.number("is", 1), arguments.number("js"), arguments.number("ks")};
  Vec3 x = perpendicular_part(zero, normal);
  if (!(norm(x) > 1e-6)) x = perpendicular_part({0, 1, 0}, normal);
  return rotation(normal, arguments.number("start")) * unit(x);
}

Outcome<Element> nominal_arc(const Arguments& arguments) {
  const Outcome<Vec3> along = direction(arguments);
  if (!along) return Outcome<Element>::failed(along.failure);
  const double radius = arguments.number("radius"), sweep = arguments.number("sweep");
  if (!(radius > 0)) return Outcome<Element>::failed("the radius must be positive");
  if (!(std::fabs(sweep) > 0)) return Outcome<Element>::failed("the arc must sweep over some angle");
  return {{.point = location(arguments),
           .direction = along.value,
           .size = radius,
           .second = start_of(arguments, along.value),
           .angle = sweep}};
}

/// A circle; the start and the sweep are those of the nominal.
void fit_arc(const PointColumns& columns, const Element* start, Element* result, const char** failure) {
  fit_lanes_of<CircleProfile>(columns, start, result, failure);
  for (int l = 0; l < columns.lanes; ++l) result[l].second = start[l].second, result[l].angle = start[l].angle;
}

Outcome<PatternTouch> touch_arc(const Element& e, bool, int k, int n) {
  const Vec3 out = rotation(e.direction, e.angle * 0.5 * (spread_evenly(k, n) + 1)) * e.second;
  return {{e.point + e.size * out, out}};
}

/// The start is written as its direction, with the start angle 0.
FeatArguments written_arc(const Element& e) {
  return {"CART", e.point, e.direction, e.size, 0.0, in_degrees(e.angle), e.second};
}

void refit_arc(FitCriterion criterion, std::span<const Vec3> points, Element& arc) {
  const double sweep = arc.angle;
  refit_by<CircleProfile>(criterion, points, arc);
  arc.angle = sweep;
}

FitSolution fit_arc_points(const FitProblem& problem, Cloud cloud, const Element* start) {
  return circle_kind.fit_points(problem, std::move(cloud), start);
}

}  // namespace

extern const FeatureKind arc_kind{
    .shape = Shape::arc,
    .acts_as = Shape::circle,
    .word = "ARC",
    .signature = "side:INNER|OUTER," ABBE_LOCATION "," ABBE_DIRECTION
                 ",radius:length,start:angle,sweep:angle[,is:number,js:number,ks:number]",
    .help = "an arc: centre, normal of its plane, radius, start angle from x or from is,js,ks, angle swept",
    .example = "F(A1)=FEAT/ARC,INNER,CART,50,50,0,0,0,1,20,0,90",
    .source = "ISO 22093:2011, FEAT/ARC; fitted as a circle",
    .nominal = nominal_arc,
    .written = written_arc,
    .normal = away_from_axis,
    .pattern = {.help = "evenly from its start to its end", .touch = touch_arc},
    .minimum_points = 3,
    .fit_lanes = fit_arc,
    .refit = refit_arc,
    .fit_points = fit_arc_points,
    .spread = 2,
};

}  // namespace abbe
