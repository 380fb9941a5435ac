// POS: the diameter of the smallest zone about the nominal location that holds the actual one,
// 2 |deviation| (ISO 5458).
//
// The deviation is the location of the feature in the datum reference frame of this machine's
// datums, minus that of the nominal in the frame of the nominal datums; datums not named leave the
// freedoms of the current coordinate system.
//
// - slots, rectangles, ellipses: their centre
// - axes, 2D and 3D: both ends of the measured axis, distance from the nominal axis, the larger of the
//   two: the zone holds the whole axis (ISO 1101:2017, clause 17)
// - 2D, other features: their centre, in the plane across the nominal direction (a sphere: across z)
// - 3D, features with a centre: in space
// - 3D, planes: a zone of parallel planes about the nominal, with the touches in it (of a median plane:
//   as in form.hpp; of a constructed plane: the rim of the area that it was made of)
//
// MMC and LMC, on the feature or on datums, leave the value and widen the zone: material.hpp.
#include <algorithm>
#include <cmath>

#include "engine/features/alignment.hpp"
#include "engine/tolerances/common.hpp"
#include "engine/tolerances/form.hpp"

namespace abbe {
namespace {

bool is_flat_zone(const Arguments& arguments) { return arguments.text("space") == "2D"; }
bool is_space_zone(const Arguments& arguments) { return !is_flat_zone(arguments); }

const char* located(const Arguments& arguments, Shapes shapes) {
  if (arguments.features("datum").size() > 3) return "a position has at most three datums";
  return acts_as(shapes[0]) == Shape::plane && is_flat_zone(arguments) ? "the position of a plane is written 3D"
                                                                       : nullptr;
}

double axis_deviation(const Element& actual, const Element& nominal) {
  auto from_nominal_axis = [&](double t) {
    return norm(perpendicular_part(actual.point + t * actual.direction - nominal.point, nominal.direction));
  };
  return std::max(from_nominal_axis(actual.begin), from_nominal_axis(actual.end));
}

/// `points` as the actual plane, in the frame of the datums.
double plane_deviation(std::span<const Vec3> points, const Element& nominal) {
  double farthest = 0;
  for (const Vec3& p : points) farthest = std::max(farthest, std::fabs(dot(p - nominal.point, nominal.direction)));
  return farthest;
}

double rim_deviation(const Element& actual, const Element& nominal) {
  const double middle = dot(actual.point - nominal.point, nominal.direction);
  const double rim = actual.end * norm(cross(actual.direction, nominal.direction));
  return std::max(std::fabs(middle + rim + actual.high), std::fabs(middle - rim + actual.low));
}

/// `own` takes the machine's D to the frame of its datums, in which `nominal` is given.
Outcome<double> zone_about(bool flat, const EvaluationInput& in, const Rigid& own, const Element& nominal) {
  const Shape shape = in.shapes[0];
  const Element actual = own * in.actual[0];
  if (has_axis(shape) && !has_centre(shape)) return {2 * axis_deviation(actual, nominal)};
  const Vec3 d = actual.point - nominal.point;
  if (flat) return {2 * norm(perpendicular_part(d, is_spot(shape) ? Vec3{0, 0, 1} : nominal.direction))};
  if (shape != Shape::plane) return {2 * norm(d)};
  std::vector<Vec3> points = points_of_plane(in);
  for (Vec3& p : points) p = own * p;
  if (!points.empty()) return {2 * plane_deviation(points, nominal)};
  return actual.end > 0 ? Outcome<double>{2 * rim_deviation(actual, nominal)} : no_value(kUnknownExtent);
}

Outcome<double> position(const Arguments& arguments, const EvaluationInput& in) {
  const bool flat = is_flat_zone(arguments);
  if (in.datums.empty()) return zone_about(flat, in, {}, in.nominal[0]);
  const Outcome<Rigid> frame = datum_reference_frame(in.datum_shapes, in.datums);
  if (!frame) return no_value(frame.failure);
  const Outcome<Rigid> nominal_frame = datum_reference_frame(in.datum_shapes, in.nominal_datums);
  if (!nominal_frame) return no_value(nominal_frame.failure);
  return zone_about(flat, in, inverse(frame.value), inverse(nominal_frame.value) * in.nominal[0]);
}

}  // namespace

extern const ToleranceKind true_position_tolerance{
    .word = "POS",
    .signature = "space:2D|3D,zone:length," ABBE_MATERIAL ",{ " ABBE_DATUM " }",
    .help =
        "position: diameter of the zone about the nominal location, in the frame of the datums, of an "
        "axis over its measured length; "
        "with MMC or LMC the actual size widens the zone",
    .example = "T(P1)=TOL/POS,3D,0.1,RFS,DAT(A),DAT(B),DAT(C)",
    .source = "ISO 22093:2011, TOL/POS; ISO 5458; ISO 5459; ASME Y14.5-2018, 10",
    .unit = Unit::mm,
    .features = 1,
    .applies = located,
    .nominal = no_deviation,
    .limits = zone_limits,
    .evaluate = position,
    .wants_touches = is_space_zone,
};

}  // namespace abbe
