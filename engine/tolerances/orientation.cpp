// PERP, PARLEL, ANGLR: the width of the zone, exactly oriented to the datum, that holds the feature
// over its measured extent (ISO 1101:2017, clause 17).
//
// With u the direction of the feature (normal or axis), v that of the datum, L the extent (length
// of an axis, diameter of the measured area of a plane) and f the spread of the residuals of a
// plane or line, the value is L s + f, where
//
//   s = |u x v|        when u and v shall be parallel,
//   s = |u v|          when they shall be at a right angle,
//   s = sin |a - a0|   when they shall make the angle a0.
//
// For planes the value is an upper bound: the touches that lie highest and lowest need not lie at
// the ends of the tilt. For an axis that shall stand on a plane or run along an axis the zone is a
// cylinder, else it is two parallel planes. An axis is straight by construction: f = 0 for
// cylinders and cones. MMC and LMC leave the value and widen the zone: material.hpp.
#include <algorithm>
#include <cmath>

#include "engine/tolerances/common.hpp"

namespace abbe {
namespace {

bool is_straight(Shape s) {
  return s == Shape::plane || s == Shape::line || s == Shape::cylinder || s == Shape::cone;
}

const char* with_extent(const Arguments&, Shapes shapes) {
  return is_straight(acts_as(shapes[0]))
             ? nullptr
             : "an orientation tolerance is for planes, lines, cylinders and cones";
}

/// What the zone turns by: 0 when exactly oriented, as a sine.
using Slope = double (*)(const Arguments&, bool same_kind, const Vec3& u, const Vec3& v);

double off_parallel(const Vec3& u, const Vec3& v) { return norm(cross(u, v)); }
double off_square(const Vec3& u, const Vec3& v) { return std::fabs(dot(u, v)); }

// Two planes, or two axes, are parallel when their directions are; a plane and an axis when they
// are at a right angle.
double perpendicular_slope(const Arguments&, bool same_kind, const Vec3& u, const Vec3& v) {
  return same_kind ? off_square(u, v) : off_parallel(u, v);
}
double parallel_slope(const Arguments&, bool same_kind, const Vec3& u, const Vec3& v) {
  return same_kind ? off_parallel(u, v) : off_square(u, v);
}
double angular_slope(const Arguments& arguments, bool same_kind, const Vec3& u, const Vec3& v) {
  const double angle = same_kind ? std::atan2(off_parallel(u, v), off_square(u, v))
                                 : std::atan2(off_square(u, v), off_parallel(u, v));
  const double wanted = arguments.number("angle"), acute = std::acos(std::fabs(std::cos(wanted)));
  return std::sin(std::fabs(angle - acute));
}

template <Slope slope>
Outcome<double> zone_width(const Arguments& arguments, const EvaluationInput& in) {
  const Element& feature = in.actual[0];
  if (is_spot(in.datum_shapes[0]))
    return no_value("a point or a sphere is no datum for an orientation");
  const double extent = feature.end - feature.begin;
  if (!(extent > 0))
    return no_value("the extent of the feature is not known, so that its orientation has no zone");
  const bool plane = in.shapes[0] == Shape::plane, line = in.shapes[0] == Shape::line;
  const bool same_kind = plane == (in.datum_shapes[0] == Shape::plane);
  const double form = plane || line ? feature.high - feature.low : 0;
  return {extent * slope(arguments, same_kind, feature.direction, in.datums[0].direction) + form};
}

}  // namespace

extern const ToleranceKind perpendicularity_tolerance{
    .word = "PERP",
    .signature = "zone:length," ABBE_MATERIAL ",datum:datum,[ datum_material:MMC|LMC|RFS ]",
    .help = "perpendicularity to a datum, over the measured extent of the feature",
    .example = "T(Q1)=TOL/PERP,0.05,DAT(A)",
    .source = "ISO 22093:2011, TOL/PERP; ISO 1101:2017, clause 17",
    .unit = Unit::mm,
    .features = 1,
    .applies = with_extent,
    .nominal = no_deviation,
    .limits = zone_limits,
    .evaluate = zone_width<perpendicular_slope>,
};

extern const ToleranceKind parallelism_tolerance{
    .word = "PARLEL",
    .signature = "zone:length," ABBE_MATERIAL ",datum:datum,[ datum_material:MMC|LMC|RFS ]",
    .help = "parallelism to a datum, over the measured extent of the feature",
    .example = "T(Q2)=TOL/PARLEL,0.05,DAT(A)",
    .source = "ISO 22093:2011, TOL/PARLEL; ISO 1101:2017, clause 17",
    .unit = Unit::mm,
    .features = 1,
    .applies = with_extent,
    .nominal = no_deviation,
    .limits = zone_limits,
    .evaluate = zone_width<parallel_slope>,
};

extern const ToleranceKind angularity_tolerance{
    .word = "ANGLR",
    .signature =
        "angle:angle,zone:length," ABBE_MATERIAL ",datum:datum,[ datum_material:MMC|LMC|RFS ]",
    .help = "angularity: at a given angle to a datum, over the measured extent of the feature",
    .example = "T(Q3)=TOL/ANGLR,30,0.05,DAT(A)",
    .source = "ISO 22093:2011, TOL/ANGLR; ISO 1101:2017, clause 17",
    .unit = Unit::mm,
    .features = 1,
    .applies = with_extent,
    .nominal = no_deviation,
    .limits = zone_limits,
    .evaluate = zone_width<angular_slope>,
};

}  // namespace abbe
