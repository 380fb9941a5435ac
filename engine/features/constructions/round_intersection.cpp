#include "engine/features/constructions/round_intersection.hpp"

#include <cmath>

namespace abbe {
namespace {

bool is_round(Shape s) { return s == Shape::circle || s == Shape::sphere; }

Outcome<Element> nearer(const Vec3& a, const Vec3& b, const Element& nominal) {
  return {{.point = norm(a - nominal.point) <= norm(b - nominal.point) ? a : b, .direction = nominal.direction}};
}

/// The line through p along the unit vector d, with the ball of radius r about c.
Outcome<Element> line_and_ball(const Vec3& p, const Vec3& d, const Vec3& c, double r, const Element& nominal) {
  const Vec3 foot = foot_on_line(p, d, c);
  const double half2 = r * r - dot(foot - c, foot - c);
  if (!(half2 >= 0)) return cannot("the line passes beside the circle or sphere");
  const double half = std::sqrt(half2);
  return nearer(foot - half * d, foot + half * d, nominal);
}

Outcome<Element> line_and_circle(const Element& line, const Element& circle, const Element& nominal) {
  const Vec3 d = perpendicular_part(line.direction, circle.direction);
  if (norm(d) < kParallel) return cannot("the line stands on the plane of the circle");
  return line_and_ball(foot_on_plane(circle.point, circle.direction, line.point), unit(d), circle.point, circle.size,
                       nominal);
}

Outcome<Element> plane_and_circle(const Element& plane, const Element& circle, const Element& nominal) {
  const Vec3 across = perpendicular_part(plane.direction, circle.direction);
  const double sine = norm(across);
  if (sine < kParallel) return cannot("the plane is parallel to that of the circle");
  const double offset = dot(plane.point - circle.point, plane.direction) / sine;
  return line_and_ball(circle.point + offset * (across / sine), cross(circle.direction, across / sine), circle.point,
                       circle.size, nominal);
}

/// In the plane of the first; their common chord lies x along the line of the centres.
Outcome<Element> two_circles(const Element& a, const Element& b, const Element& nominal) {
  if (!parallel(a.direction, b.direction)) return cannot("the two circles do not lie in parallel planes");
  const Vec3 between = perpendicular_part(b.point - a.point, a.direction);
  const double d = norm(between);
  if (!(d > 0)) return cannot("the two circles have one centre");
  const double x = (d * d + a.size * a.size - b.size * b.size) / (2 * d);
  if (!(std::fabs(x) <= a.size)) return cannot("the two circles do not meet");
  const Vec3 e = between / d;
  return line_and_ball(a.point + x * e, cross(a.direction, e), a.point, a.size, nominal);
}

}  // namespace

bool meets_round(Shapes s) {
  const bool circles = s[0] == Shape::circle && s[1] == Shape::circle;
  const bool line = (s[0] == Shape::line && is_round(s[1])) || (s[1] == Shape::line && is_round(s[0]));
  const bool plane = (s[0] == Shape::plane && s[1] == Shape::circle) || (s[1] == Shape::plane && s[0] == Shape::circle);
  return circles || line || plane;
}

Outcome<Element> round_intersection(Shapes shapes, Elements from, const Element& nominal) {
  const int second = shapes[0] == Shape::circle || shapes[0] == Shape::sphere ? 0 : 1, first = 1 - second;
  const Element &other = from[first], &round = from[second];
  if (shapes[first] == Shape::circle) return two_circles(from[0], from[1], nominal);
  if (shapes[first] == Shape::plane) return plane_and_circle(other, round, nominal);
  if (shapes[second] == Shape::circle) return line_and_circle(other, round, nominal);
  return line_and_ball(other.point, other.direction, round.point, round.size, nominal);
}

}  // namespace abbe
