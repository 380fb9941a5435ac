// ANGL: the full angle of a cone. ANGLB: the angle between two features, planes by their normals,
// others by their directions, a plane and an axis by 90 degrees minus the angle of normal and axis.
// ANGLWRT: the same angle, between one feature and the one that the tolerance names.
//
// Two features make an angle and its supplement; which one is meant is not written. It is the one that in the
// nominal geometry is nearer to the nominal value (the middle of the limits with LIMIT). The side is chosen there and
// not from what was measured, or no machine would ever find more than 90 degrees where 90 are wanted.
#include <cmath>

#include "engine/tolerances/common.hpp"

namespace abbe {
namespace {

const char* cone_only(const Arguments&, Shapes s) {
  return s[0] == Shape::cone ? nullptr : "the angle tolerance of one feature is for cones";
}

double nominal_cone(const Arguments&, Shapes, Elements nominal) { return 2 * nominal[0].angle; }

ToleranceLimits cone_limits(const Arguments& arguments, Elements nominal) {
  const double angle = 2 * nominal[0].angle;
  return {angle + arguments.number("lower"), angle + arguments.number("upper")};
}

Outcome<double> cone_angle(const Arguments&, const EvaluationInput& in) { return {2 * in.actual[0].angle}; }

const char* with_directions(const Arguments&, Shapes s) {
  return is_spot(acts_as(s[0])) || is_spot(acts_as(s[1])) ? "a point or a sphere has no direction to make an angle with"
                                                          : nullptr;
}

double expected(const Arguments& arguments) {
  if (arguments.has("nominal")) return arguments.number("nominal");
  return 0.5 * (arguments.number("lower") + arguments.number("upper"));
}

double nominal_angle(const Arguments& arguments, Shapes, Elements) { return expected(arguments); }

ToleranceLimits angle_limits(const Arguments& arguments, Elements) {
  return expected(arguments) < 0 ? written_limits(arguments) : limits_from_0(arguments);
}

/// The angle of u and v as they point; of a plane and an axis the one that has no side, up to 90 degrees.
double directed(const Vec3& u, const Vec3& v, bool plane_and_axis) {
  const double sine = norm(cross(u, v)), cosine = dot(u, v);
  return plane_and_axis ? std::atan2(std::fabs(cosine), sine) : std::atan2(sine, cosine);
}

Vec3 pointing_as(const Vec3& nominal, const Vec3& actual) { return dot(nominal, actual) < 0 ? -actual : actual; }

/// Where the two are as near, the angle is meant, whatever the last digits are.
bool supplement_is_meant(double nominal, double wanted) {
  constexpr double kClearly = 1e-9;
  return std::fabs(kPi - nominal - wanted) < std::fabs(nominal - wanted) - kClearly;
}

Outcome<double> angle_between(const Arguments& arguments, const EvaluationInput& in) {
  const bool mixed = (in.shapes[0] == Shape::plane) != (in.shapes[1] == Shape::plane);
  const Vec3 &u = in.nominal[0].direction, &v = in.nominal[1].direction;
  const double angle = directed(pointing_as(u, in.actual[0].direction), pointing_as(v, in.actual[1].direction), mixed);
  // -60 and 300 degrees are 60, written otherwise
  const double wanted = expected(arguments), turns = 2 * kPi * std::round(wanted / (2 * kPi)), side = wanted - turns;
  const double meant = supplement_is_meant(directed(u, v, mixed), std::fabs(side)) ? kPi - angle : angle;
  return {turns + (side < 0 ? -meant : meant)};
}

}  // namespace

extern const ToleranceKind feature_angle_tolerance{
    .word = "ANGL",
    .signature = "lower:angle,upper:angle",
    .help = "full angle of a cone; deviations from the nominal angle",
    .example = "T(A1)=TOL/ANGL,-0.1,0.1",
    .source = "ISO 22093:2011, TOL/ANGL",
    .unit = Unit::rad,
    .features = 1,
    .applies = cone_only,
    .nominal = nominal_cone,
    .limits = cone_limits,
    .evaluate = cone_angle,
};

extern const ToleranceKind angle_of_two_tolerance{
    .word = "ANGLB",
    .signature = ABBE_ANGLE_LIMITS,
    .help = "angle between two features",
    .example = "T(A2)=TOL/ANGLB,NOMINL,90,-0.05,0.05",
    .source = "ISO 22093:2011, TOL/ANGLB",
    .unit = Unit::rad,
    .features = 2,
    .applies = with_directions,
    .nominal = nominal_angle,
    .limits = angle_limits,
    .evaluate = angle_between,
};

extern const ToleranceKind angle_from_tolerance{
    .word = "ANGLWRT",
    .signature = ABBE_ANGLE_LIMITS "," ABBE_REFERENCE,
    .help = "angle of a feature with a reference feature, as ANGLB",
    .example = "T(A3)=TOL/ANGLWRT,NOMINL,90,-0.05,0.05,FA(PL1)",
    .source = "ISO 22093:2011, TOL/ANGLWRT",
    .unit = Unit::rad,
    .features = 1,
    .applies = with_directions,
    .nominal = nominal_angle,
    .limits = angle_limits,
    .evaluate = angle_between,
};

}  // namespace abbe
