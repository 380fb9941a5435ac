// CONCEN: twice the distance of the feature from the datum axis or datum centre: the diameter of the
// zone about it that holds the centre of a circle or sphere, or both ends of a measured axis (ISO
// 1101:2017, clause 17: concentricity and coaxiality).
//
// The datum axis is the z axis of the frame that the datums establish, so a face as primary and a
// bore as secondary datum give the axis through the bore, square to the face. A sphere or a point as
// the first datum is a datum centre: a sphere is compared in space, a circle in its own plane, an axis
// where it passes the centre.
#include <algorithm>

#include "engine/features/alignment.hpp"
#include "engine/tolerances/common.hpp"

namespace abbe {
namespace {

const char* centred(const Arguments& arguments, Shapes shapes) {
  if (arguments.features("datum").size() > 3) return "a concentricity has at most three datums";
  const Shape s = acts_as(shapes[0]);
  return has_axis(s) || has_centre(s) ? nullptr : "concentricity is for features with a centre or an axis";
}

double off_centre(Shape shape, const Element& e) {
  return norm(is_spot(shape) || shape == Shape::torus ? e.point : perpendicular_part(e.point, e.direction));
}

double off_axis(Shape shape, const Element& e) {
  const auto across = [&](double t) {
    return std::hypot(e.point.x + t * e.direction.x, e.point.y + t * e.direction.y);
  };
  return has_axis(shape) ? std::max(across(e.begin), across(e.end)) : across(0);
}

Outcome<double> concentricity(const Arguments&, const EvaluationInput& in) {
  const bool plane_only =
      std::all_of(in.datum_shapes.begin(), in.datum_shapes.end(), [](Shape s) { return s == Shape::plane; });
  if (plane_only) return no_value("a concentricity needs a datum with an axis or a centre");
  const Outcome<Rigid> frame = datum_reference_frame(in.datum_shapes, in.datums);
  if (!frame) return no_value(frame.failure);
  const Element e = inverse(frame.value) * in.actual[0];
  return {2 * (is_spot(in.datum_shapes[0]) ? off_centre(in.shapes[0], e) : off_axis(in.shapes[0], e))};
}

}  // namespace

extern const ToleranceKind concentricity_tolerance{
    .word = "CONCEN",
    .signature = "zone:length," ABBE_MATERIAL "," ABBE_DATUM ",{ " ABBE_DATUM " }",
    .help =
        "concentricity, coaxiality: twice the distance of a centre or of the ends of an axis from the datum axis or centre",
    .example = "T(CC)=TOL/CONCEN,0.05,RFS,DAT(A)",
    .source = "ISO 22093:2011, TOL/CONCEN; ISO 1101:2017, clause 17",
    .unit = Unit::mm,
    .features = 1,
    .applies = centred,
    .nominal = no_deviation,
    .limits = zone_limits,
    .evaluate = concentricity,
};

}  // namespace abbe
