// SYM: the width of the zone of two parallel planes about the datum that holds the median plane, the
// axis or the centre of the feature: twice its largest distance from the datum (ISO 1101:2017, clause
// 17: symmetry).
//
// The datum is a median plane (the mid plane of two faces, MIDPL), or an axis: then the zone lies
// along the feature's own median plane and contains the axis. A median plane is looked at where its
// faces were touched (form.hpp), an axis at both measured ends.
#include <algorithm>
#include <cmath>

#include "engine/tolerances/common.hpp"
#include "engine/tolerances/form.hpp"

namespace abbe {
namespace {

const char* any_with_place(const Arguments&, Shapes) { return nullptr; }

/// Twice the largest distance from the plane through `origin` across the unit vector n.
Outcome<double> width_about(const EvaluationInput& in, const Vec3& origin, const Vec3& n) {
  const Element& e = in.actual[0];
  const double middle = dot(e.point - origin, n);
  if (in.shapes[0] == Shape::plane) {
    double farthest = 0;
    const std::vector<Vec3> points = points_of_plane(in);
    for (const Vec3& p : points) farthest = std::max(farthest, std::fabs(dot(p - origin, n)));
    if (!points.empty()) return {2 * farthest};
    if (!(e.end > 0)) return no_value(kUnknownExtent);
    return {2 * (std::fabs(middle) + e.end * norm(cross(e.direction, n)))};
  }
  if (!has_axis(in.shapes[0])) return {2 * std::fabs(middle)};
  const double slope = dot(e.direction, n);
  return {2 * std::max(std::fabs(middle + e.begin * slope), std::fabs(middle + e.end * slope))};
}

Outcome<double> symmetry(const Arguments&, const EvaluationInput& in) {
  const Element &feature = in.actual[0], &datum = in.datums[0];
  if (in.datum_shapes[0] == Shape::plane) return width_about(in, datum.point, datum.direction);
  if (!has_axis(in.datum_shapes[0])) return no_value("the datum of a symmetry is a median plane or an axis");
  if (in.shapes[0] != Shape::plane)
    return no_value("about an axis only a median plane is symmetrical: for an axis or a centre use CONCEN");
  const Vec3 n = perpendicular_part(feature.direction, datum.direction);
  if (!(norm(n) > 0)) return no_value("the median plane lies across the datum axis");
  return width_about(in, datum.point, unit(n));
}

}  // namespace

extern const ToleranceKind symmetry_tolerance{
    .word = "SYM",
    .signature = "zone:length," ABBE_MATERIAL "," ABBE_DATUM,
    .help = "symmetry: width of the zone about a datum median plane or axis that holds a median plane, axis or centre",
    .example = "T(SY)=TOL/SYM,0.1,RFS,DAT(A)",
    .source = "ISO 22093:2011, TOL/SYM; ISO 1101:2017, clause 17",
    .unit = Unit::mm,
    .features = 1,
    .applies = any_with_place,
    .nominal = no_deviation,
    .limits = zone_limits,
    .evaluate = symmetry,
    .wants_touches = always,
};

}  // namespace abbe
