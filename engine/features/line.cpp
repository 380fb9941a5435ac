#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "engine/features/feature.hpp"
#include "engine/features/minimax_fit.hpp"
#include "engine/features/nominal.hpp"
#include "engine/features/pattern.hpp"
#include "engine/features/straight_fit.hpp"

namespace abbe {
namespace {

/// (ni, nj, nk) as a unit vector; as it is when it has no length: touches usually bring their own.
Vec3 surface_normal(const Arguments& arguments) {
  const Vec3 n{arguments.number("ni"), arguments.number("nj"), arguments.number("nk")};
  return norm(n) > 0 && std::isfinite(norm(n)) ? unit(n) : n;
}

/// From end to end: `point` is the middle, as the centroid of evenly spread touches is.
Outcome<Element> bounded(const Arguments& arguments) {
  const Vec3 from{arguments.number("x1"), arguments.number("y1"), arguments.number("z1")};
  const Vec3 to{arguments.number("x2"), arguments.number("y2"), arguments.number("z2")};
  const double length = norm(to - from);
  if (!(length > 0)) return Outcome<Element>::failed("the two ends of the line are the same point");
  return {{.point = 0.5 * (from + to),
           .direction = (to - from) / length,
           .second = surface_normal(arguments),
           .begin = -length / 2,
           .end = length / 2}};
}

Outcome<Element> nominal_line(const Arguments& arguments) {
  if (arguments.has("x1")) return bounded(arguments);
  const Outcome<Vec3> along = direction(arguments);
  if (!along) return Outcome<Element>::failed(along.failure);
  return {{.point = location(arguments), .direction = along.value, .second = surface_normal(arguments)}};
}

Outcome<PatternTouch> touch_line(const Element& e, bool, int k, int n) {
  if (!(norm(e.second) > 0))
    return Outcome<PatternTouch>::failed("the nominal line has no surface normal to touch along");
  const double half = e.end > e.begin ? e.end : kPatternReach_mm;
  return {{e.point + half * spread_evenly(k, n) * e.direction, e.second}};
}

Outcome<Vec3> line_normal(const Element& e, const Vec3&) {
  if (norm(e.second) > 0) return {e.second};
  return Outcome<Vec3>::failed("a touch on a line needs the vector of the surface in PTMEAS");
}

FeatArguments written_line(const Element& e) {
  FeatArguments out{"UNBND", "CART", e.point, e.direction};
  if (e.begin != e.end) out = {"BND", "CART", e.point + e.begin * e.direction, e.point + e.end * e.direction};
  if (norm(e.second) > 0) out.emplace_back(e.second);
  return out;
}

struct InPlane {
  double along, across;
};

/// Twice the area of the triangle a b c, positive where it turns to the left.
double turn(const InPlane& a, const InPlane& b, const InPlane& c) {
  return (b.along - a.along) * (c.across - a.across) - (b.across - a.across) * (c.along - a.along);
}

/// Corners of the smallest convex outline, all round (A. M. Andrew, Inform. Process. Lett. 9, 1979, 216-219).
std::vector<InPlane> convex_outline(std::vector<InPlane> points) {
  std::sort(points.begin(), points.end(), [](const InPlane& a, const InPlane& b) {
    return std::pair{a.along, a.across} < std::pair{b.along, b.across};
  });
  std::vector<InPlane> corners;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = corners.size();
    for (const InPlane& p : points) {
      while (corners.size() >= first + 2 && turn(corners.end()[-2], corners.back(), p) <= 0) corners.pop_back();
      corners.push_back(p);
    }
    corners.pop_back();  // with it the other side begins
    std::reverse(points.begin(), points.end());
  }
  return corners;
}

/// The middle of the narrowest strip about points in one plane, which has one of its edges along the outline; nothing
/// where they do not lie in a plane with the line. Out of the plane the distances from an axis change in second order
/// only, which the search for a cylinder settles slowly.
std::optional<Element> middle_of_strip(std::span<const Vec3> points, const Element& line) {
  constexpr double kFlat = 1e-9;  // of the extent
  const auto off = [&](const Vec3& p) { return perpendicular_part(p - line.point, line.direction); };
  const Vec3 farthest = *std::max_element(points.begin(), points.end(),
                                          [&](const Vec3& a, const Vec3& b) { return norm(off(a)) < norm(off(b)); });
  if (!(norm(off(farthest)) > 0)) return std::nullopt;
  const Vec3 across = unit(off(farthest)), normal = cross(line.direction, across);
  std::vector<InPlane> flat;
  for (const Vec3& p : points) {
    if (std::fabs(dot(p - line.point, normal)) > kFlat * (line.end - line.begin)) return std::nullopt;
    flat.push_back({dot(p - line.point, line.direction), dot(p - line.point, across)});
  }
  const std::vector<InPlane> corners = convex_outline(std::move(flat));
  Element middle = line;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const InPlane &a = corners[k], &b = corners[(k + 1) % corners.size()];
    const double length = std::hypot(b.along - a.along, b.across - a.across);
    double width = 0;
    for (const InPlane& c : corners) width = std::max(width, turn(a, b, c) / length);
    if (!(width < least)) continue;
    least = width;
    const double cosine = (b.along - a.along) / length, sine = (b.across - a.across) / length;
    middle.direction = unit(cosine * line.direction + sine * across);
    middle.point =
        line.point + (a.along - 0.5 * width * sine) * line.direction + (a.across + 0.5 * width * cosine) * across;
  }
  middle.high = 0.5 * least, middle.low = -middle.high;
  middle.begin = std::numeric_limits<double>::infinity(), middle.end = -middle.begin;
  for (const Vec3& p : points) {
    const double along = dot(p - middle.point, middle.direction);
    middle.begin = std::min(middle.begin, along), middle.end = std::max(middle.end, along);
  }
  return middle;
}

/// The axis of the narrowest cylinder that holds all points.
void refit_line(FitCriterion, std::span<const Vec3> points, Element& line) {
  if (const std::optional<Element> middle = middle_of_strip(points, line)) {
    line = *middle;
    return;
  }
  Element cylinder = line;
  cylinder.low = 0;
  refit_by<CylinderProfile>(FitCriterion::minimum_circumscribed, points, cylinder);
  line = cylinder;
  line.size = 0;
  line.high = cylinder.size, line.low = -cylinder.size;
}

}  // namespace

extern const FeatureKind line_kind{
    .shape = Shape::line,
    .flat = true,
    .word = "LINE",
    .signature = "( BND,CART,x1:length,y1:length,z1:length,x2:length,y2:length,z2:length ; UNBND," ABBE_LOCATION
                 "," ABBE_DIRECTION " ),ni:number,nj:number,nk:number",
    .help = "a straight line: its two ends, or a point and a direction, then the normal of its surface",
    .example = "F(L1)=FEAT/LINE,BND,CART,0,0,0,100,0,0,0,0,1",
    .source = "ISO 22093:2011, FEAT/LINE; total least squares (Pearson 1901)",
    .nominal = nominal_line,
    .written = written_line,
    .normal = line_normal,
    .pattern = {.help = "evenly from end to end; unbounded: over 20 mm about the point", .touch = touch_line},
    .minimum_points = 2,
    .fit_lanes = fit_line_lanes,
    .refit = refit_line,
    .fit_points = fit_line_points,
    .spread = 1,
    .fit_names = {.element = "line", .point = "point", .direction = "direction"},
};

}  // namespace abbe
