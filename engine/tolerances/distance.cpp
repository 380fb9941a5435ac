// DISTB, DISTWRT: the distance of two features, along an axis of the current coordinate system or
// straight (PT2PT). DISTWRT names the second feature itself.
//
// Along an axis it is between the points of the features: centres, of a cone the apex, of planes,
// lines and axes the middle of the touches.
//
// Straight. A plane says nothing of places within itself, and a line or an axis nothing of places
// along itself; only what the features determine counts:
//
// - two points or centres: from one to the other
// - a point and a plane: along the normal of the plane
// - a point and a line or axis: across the line
// - two parallel planes: along the mean of their normals; two parallel lines or axes: across the
//   mean of their directions. That is their distance midway between the points of the two
// - two lines or axes that are not parallel: along their common perpendicular
// - a plane and a line along it: along the normal of the plane, at the point of the line
// - planes that are not parallel, and a line that is not along a plane: they meet, and what is left
//   is from the middle of the one's touches to that of the other's
//
// The nominals decide what is parallel, so that all machines are judged alike.
//
// Sign. A distance is what one reads off a rule: unsigned. But where the limits allow negative
// values (NOMINL,0,-0.1,0.1) the program means a deviation to either side, and folding it would
// give the errors a false distribution; then the value is the second feature minus the first
// (DISTWRT: feature minus reference). PT2PT is never signed.
//
// Extent. AVG, the default, is as above. MAX and MIN are between the far and the near ends of the
// features along the line of measurement: r to both sides of a sphere, r sqrt(1 - (n e)^2) for a
// circle, and so for the circles in which a cylinder or a cone ends, a torus as that of its major radius
// and the tube's around it, the measured ends of a line, the outermost touches of a plane (a constructed one
// and a median plane have none: form, and tilt over the extent). An arc counts as its centre. Features that
// overlap have the MIN distance 0.
#include <algorithm>
#include <cmath>

#include "engine/tolerances/common.hpp"
#include "engine/tolerances/form.hpp"

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

Interval plane_reach(const Element& plane, const Vec3& e, std::span<const TouchedPoint> touches) {
  if (!are_of_one_face(touches)) {
    const double cosine = dot(plane.direction, e), rim = plane.end * norm(cross(plane.direction, e));
    return {std::min(cosine * plane.low, cosine * plane.high) - rim,
            std::max(cosine * plane.low, cosine * plane.high) + rim};
  }
  Interval reached{INFINITY, -INFINITY};
  for (const TouchedPoint& touch : touches) {
    const double height = dot(touch.actual - plane.point, e);
    reached = {std::min(reached.low, height), std::max(reached.high, height)};
  }
  return reached;
}

/// To both ends of a line, a cylinder or a cone, and there to the rim.
Interval axis_reach(Shape shape, const Element& axis, const Vec3& e) {
  const double cosine = dot(axis.direction, e), sine = norm(cross(axis.direction, e)),
               middle = dot(axis.point - location_of(shape, axis), e),
               slope = shape == Shape::cone ? std::tan(axis.angle) : 0;
  Interval reached{INFINITY, -INFINITY};
  for (const double end : {axis.begin, axis.end}) {
    const double at = middle + end * cosine, rim = shape == Shape::line ? 0 : (axis.size + end * slope) * sine;
    reached = {std::min(reached.low, at - rim), std::max(reached.high, at + rim)};
  }
  return reached;
}

/// How far the feature reaches from its location along the unit vector e.
Interval reach(Shape shape, const Element& feature, const Vec3& e, std::span<const TouchedPoint> touches) {
  const double cosine = dot(feature.direction, e);
  switch (shape) {
    case Shape::sphere: return {-feature.size, feature.size};
    case Shape::circle:
      if (feature.angle != 0) return {};  // an arc, which acts as a circle
      [[fallthrough]];
    case Shape::torus: {
      const double circle = feature.size * std::sqrt(std::max(0.0, 1 - cosine * cosine)),
                   r = shape == Shape::torus ? circle + feature.minor_size : circle;
      return {-r, r};
    }
    case Shape::plane: return plane_reach(feature, e, touches);
    case Shape::line:
    case Shape::cylinder:
    case Shape::cone: return axis_reach(shape, feature, e);
    case Shape::slot:
    case Shape::rectangle:
    case Shape::ellipse: {
      const double r = outline_reach(shape, feature, e);
      return {-r, r};
    }
    default: break;
  }
  return {};
}

/// Unit vector along which the distance is measured, and the signed distance along it.
struct Ruler {
  Vec3 along;
  double distance = 0;
};

Ruler from_end_to_end(const Vec3& from_to) {
  const double length = norm(from_to);
  return {length > 0 ? from_to / length : Vec3{1, 0, 0}, length};
}

Ruler laid_along(const Vec3& n, const Vec3& from_to) {
  const double distance = dot(from_to, n);
  return {distance < 0 ? -n : n, std::fabs(distance)};
}

Vec3 mean_direction(const Vec3& a, const Vec3& b) { return unit(a + (dot(a, b) < 0 ? -b : b)); }

bool is_straight_line(Shape s) { return s == Shape::line || s == Shape::cylinder; }

/// Two features, as measured or both as nominal; the nominal directions say what is parallel.
struct Two {
  Shape shape[2];
  const Element* element[2];
  Vec3 nominal_direction[2];

  bool parallel() const { return norm(cross(nominal_direction[0], nominal_direction[1])) < kOneDegreeSine; }
  bool square() const { return std::fabs(dot(nominal_direction[0], nominal_direction[1])) < kOneDegreeSine; }
  const Vec3& direction(int k) const { return element[k]->direction; }
  Vec3 from_to() const { return location_of(shape[1], *element[1]) - location_of(shape[0], *element[0]); }
};

Ruler between_planes(const Two& two) {
  if (!two.parallel()) return from_end_to_end(two.from_to());
  return laid_along(mean_direction(two.direction(0), two.direction(1)), two.from_to());
}

Outcome<Ruler> between_lines(const Two& two) {
  const Vec3 &a = two.direction(0), &b = two.direction(1);
  if (two.parallel()) return {from_end_to_end(perpendicular_part(two.from_to(), mean_direction(a, b)))};
  const Vec3 square_to_both = cross(a, b);
  if (!(norm(square_to_both) > 0)) return Outcome<Ruler>::failed("the lines are parallel, and their nominals are not");
  return {laid_along(unit(square_to_both), two.from_to())};
}

Outcome<Ruler> straight(const Two& two) {
  const bool plane[2] = {two.shape[0] == Shape::plane, two.shape[1] == Shape::plane};
  const bool line[2] = {is_straight_line(two.shape[0]), is_straight_line(two.shape[1])};
  if (plane[0] && plane[1]) return {between_planes(two)};
  if (line[0] && line[1]) return between_lines(two);
  if (plane[0] || plane[1]) {
    if ((line[0] || line[1]) && !two.square()) return {from_end_to_end(two.from_to())};
    return {laid_along(two.direction(plane[0] ? 0 : 1), two.from_to())};
  }
  if (line[0] || line[1]) return {from_end_to_end(perpendicular_part(two.from_to(), two.direction(line[0] ? 0 : 1)))};
  return {from_end_to_end(two.from_to())};
}

Outcome<Ruler> ruler(const Arguments& arguments, const Two& two) {
  const std::string axis = arguments.text("axis");
  if (axis == "PT2PT") return straight(two);
  Ruler r;
  const int k = axis[0] - 'X';
  r.along[k] = 1;
  r.distance = two.from_to()[k];
  return {r};
}

bool is_signed(const Arguments& arguments) {
  return arguments.text("axis") != "PT2PT" && *written_limits(arguments).lower < 0;
}

/// From feature `i` to feature `j`.
Outcome<double> measured(const Arguments& arguments, const EvaluationInput& in, int i, int j) {
  const Outcome<Ruler> made = ruler(arguments,
                                    {{in.shapes[i], in.shapes[j]},
                                     {&in.actual[i], &in.actual[j]},
                                     {in.nominal[i].direction, in.nominal[j].direction}});
  if (!made) return no_value(made.failure);
  const Ruler& r = made.value;
  const std::string use = arguments.text("use", "AVG");
  double value = std::fabs(r.distance);
  const double sense = r.distance < 0 ? -1 : 1;
  if (use != "AVG") {
    const std::span<const TouchedPoint> touches[] = {in.touches, in.second_touches};
    const Interval a = reach(in.shapes[i], in.actual[i], sense * r.along, touches[i]),
                   b = reach(in.shapes[j], in.actual[j], sense * r.along, touches[j]);
    value = use == "MAX" ? value + b.high - a.low : std::max(0.0, value + b.low - a.high);
  }
  return {is_signed(arguments) ? sense * value : value};
}

/// Lines whose nominals have no distance get 0, and nothing is evaluated.
double nominal_distance(const Arguments& arguments, Shapes shapes, Elements nominal, int i, int j) {
  if (arguments.has("nominal")) return arguments.number("nominal");
  const double d =
      ruler(arguments,
            {{shapes[i], shapes[j]}, {&nominal[i], &nominal[j]}, {nominal[i].direction, nominal[j].direction}})
          .value.distance;
  return is_signed(arguments) ? d : std::fabs(d);
}

const char* any_features(const Arguments&, Shapes) { return nullptr; }

ToleranceLimits distance_limits(const Arguments& arguments, Elements) {
  return is_signed(arguments) ? written_limits(arguments) : limits_from_0(arguments);
}

double nominal_between(const Arguments& arguments, Shapes shapes, Elements nominal) {
  return nominal_distance(arguments, shapes, nominal, 0, 1);
}

double nominal_from(const Arguments& arguments, Shapes shapes, Elements nominal) {
  return nominal_distance(arguments, shapes, nominal, 1, 0);
}

Outcome<double> between(const Arguments& arguments, const EvaluationInput& in) { return measured(arguments, in, 0, 1); }

Outcome<double> from_reference(const Arguments& arguments, const EvaluationInput& in) {
  return measured(arguments, in, 1, 0);
}

/// Where the outermost touches of a plane are the ends of the distance.
bool reaches_to_ends(const Arguments& arguments) { return arguments.text("use", "AVG") != "AVG"; }

}  // namespace

extern const ToleranceKind distance_between_tolerance{
    .word = "DISTB",
    .signature = ABBE_LENGTH_LIMITS ",axis:XAXIS|YAXIS|ZAXIS|PT2PT,[ use:AVG|MAX|MIN ]",
    .help =
        "distance between two features along an axis, or straight: of planes along their normal, of "
        "lines and axes across them; signed only where the limits allow negative values",
    .example = "T(D1)=TOL/DISTB,NOMINL,100,-0.05,0.05,XAXIS,AVG",
    .source = "ISO 22093:2011, TOL/DISTB",
    .unit = Unit::mm,
    .features = 2,
    .applies = any_features,
    .nominal = nominal_between,
    .limits = distance_limits,
    .evaluate = between,
    .wants_touches = reaches_to_ends,
};

extern const ToleranceKind distance_from_tolerance{
    .word = "DISTWRT",
    .signature = ABBE_LENGTH_LIMITS "," ABBE_REFERENCE ",axis:XAXIS|YAXIS|ZAXIS|PT2PT,[ use:AVG|MAX|MIN ]",
    .help =
        "distance of a feature from a reference feature, as DISTB; signed only where the limits "
        "allow negative values",
    .example = "T(D2)=TOL/DISTWRT,NOMINL,25,-0.05,0.05,FA(PL1),ZAXIS,AVG",
    .source = "ISO 22093:2011, TOL/DISTWRT",
    .unit = Unit::mm,
    .features = 1,
    .applies = any_features,
    .nominal = nominal_from,
    .limits = distance_limits,
    .evaluate = from_reference,
    .wants_touches = reaches_to_ends,
};

}  // namespace abbe
