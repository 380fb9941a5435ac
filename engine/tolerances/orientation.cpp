// PERP, PARLEL, ANGLR: the width of the zone, exactly oriented to the datum, that holds the feature
// (ISO 1101:2017, clause 17).
//
// Let u be the direction of the feature (normal or axis), v that of the datum, turned so that
// u v >= 0, and a the angle that the two shall make: 0 for planes or axes that shall be parallel, 90
// degrees where one shall be a plane and the other an axis, and so on.
//
// A measured plane: the zone is two parallel planes, exactly at a to the datum, about the touches.
// Their normal is w = cos a v + sin a p with p the part of u across v; the value is the range of
// the touches along w. Where the zone may turn about v (sin a > 0) it follows the fitted plane. Of a
// median plane the zone holds the touches of its faces, each at its foot on the median plane.
//
// A measured line: the zone is two parallel planes about the touches as well, with the normal
// w = sin a v - cos a p. A line that shall run along v (a = 0) has two parallel lines about it, in the
// section that v and the normal of the surface span; an axis, which has no such section, a cylinder
// along v about the middle of the fitted axis. So has a line that runs across v instead: in the
// section of v it would be a point, with a zone of 0.
//
// Everything else: with L the extent (length of an axis, diameter of the area of a constructed plane)
// and f the spread of the residuals of a constructed plane or line, the value is L s + f, where
// s = |cos a |u x v| - sin a |u v|| is the sine of what the direction is off. For an axis that shall
// stand on a plane or run along an axis the zone is a cylinder, else it is two parallel planes. An axis
// is straight by construction: f = 0 for cylinders and cones.
//
// MMC and LMC leave the value and widen the zone: material.hpp.
#include <algorithm>
#include <cmath>

#include "engine/tolerances/common.hpp"
#include "engine/tolerances/form.hpp"

namespace abbe {
namespace {

bool is_straight(Shape s) { return s == Shape::plane || s == Shape::line || s == Shape::cylinder || s == Shape::cone; }

const char* with_extent(const Arguments&, Shapes shapes) {
  return is_straight(acts_as(shapes[0])) ? nullptr
                                         : "an orientation tolerance is for planes, lines, cylinders and cones";
}

/// Of the angle that the directions of feature and datum shall make, from 0 to 90 degrees.
struct Inclination {
  double cosine, sine;
};
constexpr Inclination kAlong{1, 0}, kAcross{0, 1};
constexpr double kRunsAcross = 0.7071;   ///< cosine up to which a line runs across the datum more than along it
constexpr double kAlongTheDatum = 1e-9;  ///< sine of an angle that was written as 0 or 90 degrees
using Wanted = Inclination (*)(const Arguments&, bool same_kind);

// Two planes, or two axes, are parallel when their directions are; a plane and an axis when they
// are at a right angle.
Inclination perpendicular(const Arguments&, bool same_kind) { return same_kind ? kAcross : kAlong; }
Inclination parallel(const Arguments&, bool same_kind) { return same_kind ? kAlong : kAcross; }
Inclination angular(const Arguments& arguments, bool same_kind) {
  const double angle = arguments.number("angle");
  const double c = std::fabs(std::cos(angle)), s = std::fabs(std::sin(angle));
  return same_kind ? Inclination{c, s} : Inclination{s, c};
}

/// The normal of the zone about a plane whose normal is u.
Vec3 zone_normal(const Vec3& u, const Vec3& datum, Inclination wanted) {
  const Vec3 v = dot(u, datum) < 0 ? -datum : datum;
  const Vec3 across = u - dot(u, v) * v;
  const double length = norm(across);
  if (length > 0) return wanted.cosine * v + (wanted.sine / length) * across;
  // A plane that lies along the datum and shall stand on it: no side is nearer than another.
  return wanted.cosine * v + wanted.sine * any_perpendicular(v);
}

/// The zone that holds the touches of a line whose zone is at `wanted` to the datum.
double line_zone(const EvaluationInput& in, const Vec3& datum, Inclination wanted) {
  const Element& line = in.actual[0];
  const Vec3 v = dot(line.direction, datum) < 0 ? -datum : datum;
  if (wanted.sine > kAlongTheDatum) {
    const Vec3 across = perpendicular_part(line.direction, v);
    const Vec3 p = norm(across) > 0 ? unit(across) : any_perpendicular(v);
    return range_along(wanted.sine * v - wanted.cosine * p, in.touches);
  }
  const std::optional<Vec3> normal = section_normal(in.touches, v);
  if (normal && dot(line.direction, v) > kRunsAcross) return range_along(*normal, in.touches);
  const Vec3 middle = line.point + 0.5 * (line.begin + line.end) * line.direction;
  double radius = 0;
  for (const TouchedPoint& touch : in.touches)
    radius = std::max(radius, norm(perpendicular_part(touch.actual - middle, v)));
  return 2 * radius;
}

template <Wanted wanted_for>
Outcome<double> zone_width(const Arguments& arguments, const EvaluationInput& in) {
  const Element& feature = in.actual[0];
  if (is_spot(in.datum_shapes[0])) return no_value("a point or a sphere is no datum for an orientation");
  const bool plane = in.shapes[0] == Shape::plane, line = in.shapes[0] == Shape::line;
  const Inclination wanted = wanted_for(arguments, plane == (in.datum_shapes[0] == Shape::plane));
  const Vec3 u = feature.direction, v = in.datums[0].direction;
  if (plane)
    if (const std::vector<Vec3> points = points_of_plane(in); !points.empty())
      return {range_along(zone_normal(u, v, wanted), points)};
  if (line && !in.touches.empty()) return {line_zone(in, v, wanted)};
  const double extent = feature.end - feature.begin;
  if (!(extent > 0)) return no_value(kUnknownExtent);
  const double slope = std::fabs(wanted.cosine * norm(cross(u, v)) - wanted.sine * std::fabs(dot(u, v)));
  const double form = plane || line ? feature.high - feature.low : 0;
  return {extent * slope + form};
}

}  // namespace

extern const ToleranceKind perpendicularity_tolerance{
    .word = "PERP",
    .signature = "zone:length," ABBE_MATERIAL "," ABBE_DATUM,
    .help =
        "perpendicularity to a datum: of a plane or line the zone that holds its touches, of an axis over its measured length",
    .example = "T(Q1)=TOL/PERP,0.05,DAT(A)",
    .source = "ISO 22093:2011, TOL/PERP; ISO 1101:2017, clause 17",
    .unit = Unit::mm,
    .features = 1,
    .applies = with_extent,
    .nominal = no_deviation,
    .limits = zone_limits,
    .evaluate = zone_width<perpendicular>,
    .wants_touches = always,
};

extern const ToleranceKind parallelism_tolerance{
    .word = "PARLEL",
    .signature = "zone:length," ABBE_MATERIAL "," ABBE_DATUM,
    .help =
        "parallelism to a datum: of a plane or line the zone that holds its touches, of an axis over its measured length",
    .example = "T(Q2)=TOL/PARLEL,0.05,DAT(A)",
    .source = "ISO 22093:2011, TOL/PARLEL; ISO 1101:2017, clause 17",
    .unit = Unit::mm,
    .features = 1,
    .applies = with_extent,
    .nominal = no_deviation,
    .limits = zone_limits,
    .evaluate = zone_width<parallel>,
    .wants_touches = always,
};

extern const ToleranceKind angularity_tolerance{
    .word = "ANGLR",
    .signature = "angle:angle,zone:length," ABBE_MATERIAL "," ABBE_DATUM,
    .help =
        "angularity: at a given angle to a datum; of a plane or line the zone that holds its touches, of an axis over its measured length",
    .example = "T(Q3)=TOL/ANGLR,30,0.05,DAT(A)",
    .source = "ISO 22093:2011, TOL/ANGLR; ISO 1101:2017, clause 17",
    .unit = Unit::mm,
    .features = 1,
    .applies = with_extent,
    .nominal = no_deviation,
    .limits = zone_limits,
    .evaluate = zone_width<angular>,
    .wants_touches = always,
};

}  // namespace abbe
