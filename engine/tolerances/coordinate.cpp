// CORTOL: the deviation of a coordinate of the feature's point from its nominal, in the current
// coordinate system: x, y, z, or in the xy plane the distance from z and the polar angle. The angle
// of a point on z itself is not defined.
//
// The point is the one that FEAT gives: a point, a centre, the apex of a cone. A plane has no point of
// its own, nor has a line or an axis: the middle of the touches moves with every change of the
// touches. So theirs is the foot of the nominal point on the measured plane, line or axis.
#include <cmath>

#include "engine/tolerances/common.hpp"

namespace abbe {
namespace {

constexpr double kOnAxis_mm = 1e-6;

const char* any_feature(const Arguments&, Shapes) { return nullptr; }

ToleranceLimits coordinate_limits(const Arguments& arguments, Elements) {
  return {arguments.number("lower"), arguments.number("upper")};
}

Unit unit(const Arguments& arguments) { return arguments.text("axis") == "ANGLE" ? Unit::rad : Unit::mm; }

Vec3 actual_point(Shape shape, const Element& actual, const Vec3& nominal) {
  const Vec3 beside = nominal - actual.point;
  switch (shape) {
    case Shape::plane: return nominal - dot(beside, actual.direction) * actual.direction;
    case Shape::line:
    case Shape::cylinder: return nominal - perpendicular_part(beside, actual.direction);
    default: return location_of(shape, actual);
  }
}

Outcome<double> coordinate_deviation(const Arguments& arguments, const EvaluationInput& in) {
  const Vec3 n = location_of(in.shapes[0], in.nominal[0]), a = actual_point(in.shapes[0], in.actual[0], n);
  const std::string axis = arguments.text("axis");
  if (axis == "RADIUS") return {std::hypot(a.x, a.y) - std::hypot(n.x, n.y)};
  if (axis == "ANGLE") {
    if (std::hypot(a.x, a.y) < kOnAxis_mm || std::hypot(n.x, n.y) < kOnAxis_mm)
      return no_value("a point on the z axis has no polar angle");
    return {std::atan2(n.x * a.y - n.y * a.x, n.x * a.x + n.y * a.y)};  // from n to a, within half a turn
  }
  const int k = axis[0] - 'X';
  return {a[k] - n[k]};
}

}  // namespace

extern const ToleranceKind coordinate_tolerance{
    .word = "CORTOL",
    .signature =
        "( axis:XAXIS|YAXIS|ZAXIS|RADIUS,lower:length,upper:length ; "
        "axis:ANGLE,lower:angle,upper:angle )",
    .help =
        "deviation of one coordinate of the feature from its nominal; of planes, lines and axes where "
        "they pass the nominal point",
    .example = "T(X1)=TOL/CORTOL,XAXIS,-0.05,0.05",
    .source = "ISO 22093:2011, TOL/CORTOL",
    .unit = Unit::mm,
    .features = 1,
    .applies = any_feature,
    .nominal = no_deviation,
    .limits = coordinate_limits,
    .evaluate = coordinate_deviation,
    .unit_for = unit,
};

}  // namespace abbe
