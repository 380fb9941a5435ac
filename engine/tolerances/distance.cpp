// DISTB, DISTWRT: the distance of two features, between their points along an axis of the current
// coordinate system or straight (PT2PT). DISTWRT names the second feature itself.
//
// Sign. A distance is what one reads off a rule: unsigned. But where the limits allow negative
// values (NOMINL,0,-0.1,0.1) the program means a deviation to either side, and folding it would
// give the errors a false distribution; then the value is the second feature minus the first
// (DISTWRT: feature minus reference). PT2PT is never signed.
//
// Extent. AVG, the default, is between the points (centres). MAX and MIN are between the far and
// the near ends of the features along the line of measurement: r to both sides of a sphere, r
// sqrt(1 - (n e)^2) for a circle, the measured ends of a line or an axis, the outermost touches of
// a plane. Features that overlap have the MIN distance 0.
#include <algorithm>
#include <cmath>

#include "engine/tolerances/common.hpp"

namespace abbe {
namespace {

struct Interval {
  double low = 0, high = 0;
};

/// How far an outline reaches from its centre along the unit vector e, to both sides.
double outline_reach(Shape shape, const Element& o, const Vec3& e) {
  const double u = std::fabs(dot(o.second, e)), v = std::fabs(dot(cross(o.direction, o.second), e));
  if (shape == Shape::ellipse) return std::hypot(o.size * u, o.minor_size * v);
  if (shape == Shape::rectangle || o.angle != 0) return o.size * u + o.minor_size * v;
  return (o.size - o.minor_size) * u + o.minor_size * std::hypot(u, v);
}

/// How far the feature reaches from its point along the unit vector e.
Interval reach(Shape shape, const Element& feature, const Vec3& e) {
  const double cosine = dot(feature.direction, e);
  switch (shape) {
    case Shape::sphere:
      return {-feature.size, feature.size};
    case Shape::circle: {
      const double r = feature.size * std::sqrt(std::max(0.0, 1 - cosine * cosine));
      return {-r, r};
    }
    case Shape::plane:
      return {std::min(cosine * feature.low, cosine * feature.high),
              std::max(cosine * feature.low, cosine * feature.high)};
    case Shape::line:
    case Shape::cylinder:
    case Shape::cone:
      return {std::min(cosine * feature.begin, cosine * feature.end),
              std::max(cosine * feature.begin, cosine * feature.end)};
    case Shape::slot:
    case Shape::rectangle:
    case Shape::ellipse: {
      const double r = outline_reach(shape, feature, e);
      return {-r, r};
    }
    default:
      break;
  }
  return {};
}

/// Unit vector along which the distance is measured, and the signed distance of the points along
/// it.
struct Ruler {
  Vec3 along;
  double distance = 0;
};

Ruler ruler(const Arguments& arguments, const Vec3& from_to) {
  const std::string axis = arguments.text("axis");
  if (axis == "PT2PT") {
    const double length = norm(from_to);
    return {length > 0 ? from_to / length : Vec3{1, 0, 0}, length};
  }
  Ruler r;
  const int k = axis[0] - 'X';
  r.along[k] = 1;
  r.distance = from_to[k];
  return r;
}

bool is_signed(const Arguments& arguments) {
  return arguments.text("axis") != "PT2PT" && *written_limits(arguments).lower < 0;
}

/// From feature `i` to feature `j`.
double measured(const Arguments& arguments, const EvaluationInput& in, int i, int j) {
  const Element &from = in.actual[i], &to = in.actual[j];
  const Ruler r = ruler(arguments, to.point - from.point);
  const std::string use = arguments.text("use", "AVG");
  double value = std::fabs(r.distance);
  const double sense = r.distance < 0 ? -1 : 1;
  if (use != "AVG") {
    const Interval a = reach(in.shapes[i], from, sense * r.along),
                   b = reach(in.shapes[j], to, sense * r.along);
    value = use == "MAX" ? value + b.high - a.low : std::max(0.0, value + b.low - a.high);
  }
  return is_signed(arguments) ? sense * value : value;
}

double nominal_distance(const Arguments& arguments, const Element& from, const Element& to) {
  if (arguments.has("nominal")) return arguments.number("nominal");
  const double d = ruler(arguments, to.point - from.point).distance;
  return is_signed(arguments) ? d : std::fabs(d);
}

const char* any_features(const Arguments&, Shapes) { return nullptr; }

ToleranceLimits distance_limits(const Arguments& arguments, Elements) { return written_limits(arguments); }

double nominal_between(const Arguments& arguments, Shapes, Elements nominal) {
  return nominal_distance(arguments, nominal[0], nominal[1]);
}

double nominal_from(const Arguments& arguments, Shapes, Elements nominal) {
  return nominal_distance(arguments, nominal[1], nominal[0]);
}

Outcome<double> between(const Arguments& arguments, const EvaluationInput& in) {
  return {measured(arguments, in, 0, 1)};
}

Outcome<double> from_reference(const Arguments& arguments, const EvaluationInput& in) {
  return {measured(arguments, in, 1, 0)};
}

}  // namespace

extern const ToleranceKind distance_between_tolerance{
    .word = "DISTB",
    .signature = ABBE_LENGTH_LIMITS ",axis:XAXIS|YAXIS|ZAXIS|PT2PT,[ use:AVG|MAX|MIN ]",
    .help =
        "distance between two features along an axis or straight; signed only where the limits "
        "allow negative values",
    .example = "T(D1)=TOL/DISTB,NOMINL,100,-0.05,0.05,XAXIS,AVG",
    .source = "ISO 22093:2011, TOL/DISTB",
    .unit = Unit::mm,
    .features = 2,
    .applies = any_features,
    .nominal = nominal_between,
    .limits = distance_limits,
    .evaluate = between,
};

extern const ToleranceKind distance_from_tolerance{
    .word = "DISTWRT",
    .signature =
        ABBE_LENGTH_LIMITS ",reference:feature,axis:XAXIS|YAXIS|ZAXIS|PT2PT,[ use:AVG|MAX|MIN ]",
    .help =
        "distance of a feature from a reference feature; signed only where the limits allow "
        "negative values",
    .example = "T(D2)=TOL/DISTWRT,NOMINL,25,-0.05,0.05,FA(PL1),ZAXIS,AVG",
    .source = "ISO 22093:2011, TOL/DISTWRT",
    .unit = Unit::mm,
    .features = 1,
    .applies = any_features,
    .nominal = nominal_from,
    .limits = distance_limits,
    .evaluate = from_reference,
};

}  // namespace abbe
