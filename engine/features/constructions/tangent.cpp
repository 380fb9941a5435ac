// TANTO: a line that touches a circle and passes through a point, or touches two circles; a circle of
// the nominal size that touches two lines (a fillet).
//
// All is done in the plane of the first circle (of the two lines). There are two tangents through a
// point, four to two circles and four fillets: the one whose place is nearest to the nominal point is
// meant.
#include <cmath>

#include "engine/features/constructions/tools.hpp"

namespace abbe {
namespace {

/// Keeps the candidate nearest to the nominal point.
class Nearest {
 public:
  explicit Nearest(const Element& nominal) : nominal_(nominal) {}
  void line(const Vec3& touch, const Vec3& along) {
    consider({.point = touch, .direction = along}, norm(nominal_.point - foot_on_line(touch, along, nominal_.point)));
  }
  void circle(const Vec3& centre, const Vec3& normal) {
    consider({.point = centre, .direction = normal, .size = nominal_.size}, norm(nominal_.point - centre));
  }
  Outcome<Element> made() const { return {in_sense_of(nominal_, best_)}; }

 private:
  void consider(const Element& e, double distance) {
    if (distance < least_) least_ = distance, best_ = e;
  }
  const Element& nominal_;
  Element best_;
  double least_ = INFINITY;
};

/// The line has the unit normal m in the plane; m . (c2 - c1) = r1 -+ r2 for tangents that leave the
/// circles on one side, or on two. A point is a circle of radius 0.
Outcome<Element> common_tangent(const Element& circle, const Element& other, double other_radius,
                                const Element& nominal) {
  const Vec3 n = circle.direction, between = perpendicular_part(other.point - circle.point, n);
  const double d = norm(between);
  if (!(d > 0)) return cannot("a tangent needs two different places");
  const Vec3 e = between / d, across = cross(n, e);
  Nearest nearest(nominal);
  bool any = false;
  for (const double side : {1.0, -1.0}) {
    const double h = (circle.size - side * other_radius) / d;
    if (!(std::fabs(h) <= 1)) continue;
    any = true;
    for (const double turn : {1.0, -1.0}) {
      const Vec3 m = h * e + turn * std::sqrt(1 - h * h) * across;
      nearest.line(circle.point + circle.size * m, cross(n, m));
    }
  }
  return any ? nearest.made() : cannot("there is no tangent: one lies inside the other");
}

Outcome<Element> fillet(const Element& a, const Element& b, const Element& nominal) {
  const Vec3 n = cross(a.direction, b.direction);
  const double sine = norm(n);
  if (sine < kParallel) return cannot("the lines are parallel");
  if (!(nominal.size > 0)) return cannot("the nominal circle says how large the circle is, and it has no size");
  const Vec3 gap = perpendicular_part(b.point - a.point, n / sine);
  const Vec3 corner = a.point + dot(cross(gap, b.direction), n) / (sine * sine) * a.direction;
  Nearest nearest(nominal);
  for (const double s : {1.0, -1.0})
    for (const double t : {1.0, -1.0})
      nearest.circle(corner + nominal.size / sine * (s * a.direction + t * b.direction), n / sine);
  return nearest.made();
}

const char* tangent_applies(Shape result, Shapes shapes) {
  const auto all = [&](auto fits) { return fits(shapes[0]) && fits(shapes[1]); };
  const bool circle = result == Shape::circle && all([](Shape s) { return s == Shape::line; });
  const bool line = result == Shape::line && all([](Shape s) { return s == Shape::circle || s == Shape::point; }) &&
      (shapes[0] == Shape::circle || shapes[1] == Shape::circle);
  return circle || line ? nullptr
                        : "TANTO makes a line of a circle and a point or of two circles, or a circle of two lines";
}

Outcome<Element> tangent(Shape result, Shapes shapes, Elements from, const Element& nominal, const Arguments&) {
  if (result == Shape::circle) return fillet(from[0], from[1], nominal);
  const int first = shapes[0] == Shape::circle ? 0 : 1, second = 1 - first;
  return common_tangent(from[first], from[second], shapes[second] == Shape::circle ? from[second].size : 0, nominal);
}

}  // namespace

extern const Construction tangent_method{
    .word = "TANTO",
    .signature = "from:feature,[THRU],from:feature",
    .help =
        "a line tangent to a circle through a point, or to two circles; a circle of the nominal size tangent to two lines",
    .example = "CONST/LINE,F(L),TANTO,FA(C),THRU,FA(P)",
    .source = "ISO 22093:2011, CONST TANTO",
    .applies = tangent_applies,
    .construct = tangent,
};

}  // namespace abbe
