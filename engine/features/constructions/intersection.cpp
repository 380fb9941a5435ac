// INTOF: what two or three features have in common.
//
// - line: two planes, n1 x n2; its point is the one nearest to the middle of the planes' points
// - point: axis and plane; two axes (the middle of their shortest connection, so that lines
//   measured at different heights meet); three planes (Cramer's rule)
// - point, of a line and a circle or sphere, a plane and a circle, or two circles: of the two
//   the one nearer to the nominal (round_intersection.cpp)
// - circle: plane and sphere; plane and cylinder or cone whose axis is square to it within
//   1 degree; the normal is that of the plane
// - ellipse: plane and cylinder
#include <cmath>

#include "engine/base/ids.hpp"
#include "engine/features/constructions/round_intersection.hpp"
#include "engine/features/constructions/tools.hpp"

namespace abbe {
namespace {

Outcome<Element> line_of_planes(const Element& a, const Element& b, const Element& nominal) {
  const Vec3 d = cross(a.direction, b.direction);
  const double sine2 = dot(d, d);
  if (sine2 < kParallel * kParallel) return cannot("the planes are parallel");
  const Vec3 middle = 0.5 * (a.point + b.point);
  const double ha = dot(a.point - middle, a.direction), hb = dot(b.point - middle, b.direction);
  const Vec3 point = middle + (ha * cross(b.direction, d) + hb * cross(d, a.direction)) / sine2;
  return {in_sense_of(nominal, {.point = point, .direction = d / std::sqrt(sine2)})};
}

Outcome<Element> point_on_plane(const Element& axis, const Element& plane) {
  if (std::fabs(dot(axis.direction, plane.direction)) < kParallel) return cannot("the line is parallel to the plane");
  return {{.point = line_meets_plane(axis.point, axis.direction, plane), .direction = plane.direction}};
}

Outcome<Element> point_of_axes(const Element& a, const Element& b, const Element& nominal) {
  const Vec3 n = cross(a.direction, b.direction), gap = b.point - a.point;
  const double sine2 = dot(n, n);
  if (sine2 < kParallel * kParallel) return cannot("the lines are parallel");
  const Vec3 on_a = a.point + dot(cross(gap, b.direction), n) / sine2 * a.direction;
  const Vec3 on_b = b.point + dot(cross(gap, a.direction), n) / sine2 * b.direction;
  return {{.point = 0.5 * (on_a + on_b), .direction = nominal.direction}};
}

Outcome<Element> point_of_planes(Elements p, const Element& nominal) {
  const Vec3 yz = cross(p[1].direction, p[2].direction), zx = cross(p[2].direction, p[0].direction),
             xy = cross(p[0].direction, p[1].direction);
  const double volume = dot(p[0].direction, yz);
  if (std::fabs(volume) < kParallel)
    return cannot("two of the planes are parallel, or all three run along one direction");
  auto height = [&](int i) { return dot(p[i].direction, p[i].point - p[0].point); };
  return {{.point = p[0].point + (height(1) * zx + height(2) * xy) / volume, .direction = nominal.direction}};
}

Outcome<Element> section(const Element& plane, Shape shape, const Element& body, const Element& nominal) {
  Element circle;
  circle.direction = plane.direction;
  if (shape == Shape::sphere) {
    const double height = dot(body.point - plane.point, plane.direction);
    if (!(std::fabs(height) < body.size)) return cannot("the plane does not cut the sphere");
    circle.point = body.point - height * plane.direction;
    circle.size = std::sqrt(body.size * body.size - height * height);
  } else {
    if (norm(cross(body.direction, plane.direction)) > kOneDegreeSine)
      return cannot("the section is not a circle: the plane is not square to the axis");
    circle.point = line_meets_plane(body.point, body.direction, plane);
    circle.size = body.size;
    if (shape == Shape::cone) circle.size += dot(circle.point - body.point, body.direction) * std::tan(body.angle);
    if (!(circle.size > 0)) return cannot("the plane lies beyond the apex of the cone");
  }
  return {in_sense_of(nominal, circle)};
}

Outcome<Element> oblique_section(const Element& plane, const Element& body, const Element& nominal) {
  const double cosine = std::fabs(dot(plane.direction, body.direction));
  if (cosine < kParallel) return cannot("the plane runs along the axis of the cylinder");
  const Vec3 along = perpendicular_part(body.direction, plane.direction);
  const Vec3 major = norm(along) > 1e-9 ? unit(along) : any_perpendicular(plane.direction);
  return {{.point = line_meets_plane(body.point, body.direction, plane),
           .direction = plane.direction,
           .size = body.size / cosine,
           .minor_size = body.size,
           .second = dot(major, nominal.second) < 0 ? -major : major}};
}

/// What two features have in common.
enum class Common { nothing, line_of_planes, point_on_plane, point_of_axes, section, oblique_section, round };

Common common(Shape result, Shapes shapes) {
  const int planes = (shapes[0] == Shape::plane) + (shapes[1] == Shape::plane);
  const Shape other = shapes[shapes[0] == Shape::plane ? 1 : 0];
  if (result == Shape::line && planes == 2) return Common::line_of_planes;
  if (result == Shape::point && planes == 1 && has_axis(other)) return Common::point_on_plane;
  if (result == Shape::point && has_axis(shapes[0]) && has_axis(shapes[1])) return Common::point_of_axes;
  if (result == Shape::circle && planes == 1 &&
      (other == Shape::sphere || other == Shape::cylinder || other == Shape::cone))
    return Common::section;
  if (result == Shape::ellipse && planes == 1 && other == Shape::cylinder) return Common::oblique_section;
  if (result == Shape::point && meets_round(shapes)) return Common::round;
  return Common::nothing;
}

const char* intersect_applies(Shape result, Shapes shapes) {
  if (shapes.size() == 2)
    return common(result, shapes) != Common::nothing
        ? nullptr
        : "INTOF makes a line of two planes, a point of lines, planes and round features, or a "
          "circle or ellipse of a plane and a cylinder, cone or sphere";
  for (const Shape shape : shapes)
    if (shape != Shape::plane) return "INTOF of three features takes three planes";
  return result == Shape::point ? nullptr : "three planes meet in a point";
}

Outcome<Element> intersect(Shape result, Shapes shapes, Elements from, const Element& nominal, const Arguments&) {
  if (from.size() == 3) return point_of_planes(from, nominal);
  const int first = shapes[0] == Shape::plane ? 0 : 1, second = 1 - first;
  switch (common(result, shapes)) {
    case Common::line_of_planes: return line_of_planes(from[0], from[1], nominal);
    case Common::point_on_plane: return point_on_plane(from[second], from[first]);
    case Common::point_of_axes: return point_of_axes(from[0], from[1], nominal);
    case Common::section: return section(from[first], shapes[second], from[second], nominal);
    case Common::oblique_section: return oblique_section(from[first], from[second], nominal);
    case Common::round: return round_intersection(shapes, from, nominal);
    case Common::nothing: break;
  }
  ABBE_CHECK(false);
}

}  // namespace

extern const Construction intersection_method{
    .word = "INTOF",
    .signature = "from:feature,from:feature,[from:feature]",
    .help =
        "intersection: line of two planes; point of two axes, axis and plane, or three planes; "
        "point of a line with a circle or sphere, a plane with a circle, two circles (the one nearer "
        "to the nominal); circle or ellipse of plane and round surface",
    .example = "CONST/LINE,F(L1),INTOF,FA(P1),FA(P2)",
    .source = "ISO 22093:2011, CONST INTOF",
    .applies = intersect_applies,
    .construct = intersect,
};

}  // namespace abbe
