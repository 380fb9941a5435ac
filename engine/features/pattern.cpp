#include "engine/features/pattern.hpp"

#include <algorithm>
#include <cmath>

#include "engine/features/outline.hpp"

namespace abbe {
namespace {

/// Two directions across the unit vector n: that of x (of y when n runs along x), and the next.
struct Across {
  Vec3 a, b;
  explicit Across(const Vec3& n) {
    const Vec3 x = perpendicular_part({1, 0, 0}, n);
    a = unit(norm(x) > 0.5 ? x : perpendicular_part({0, 1, 0}, n));
    b = cross(n, a);
  }
  Vec3 at(double angle) const { return std::cos(angle) * a + std::sin(angle) * b; }
};

/// Step k of n equal steps from -1 to 1; a single one is in the middle.
double spread_evenly(int k, int n) { return n > 1 ? 2.0 * k / (n - 1) - 1 : 0; }

/// Row by row over a square of as many columns as rows, or one more.
struct Grid {
  double a, b;
  Grid(int index, int count) {
    const int columns = std::max(1, static_cast<int>(std::ceil(std::sqrt(count)))),
              rows = (count + columns - 1) / columns;
    const int row = index / columns, in_row = std::min(columns, count - row * columns);
    a = kPatternReach_mm * spread_evenly(index % columns, in_row), b = kPatternReach_mm * spread_evenly(row, rows);
  }
};

PatternTouch on_plane(const Element& e, int k, int n) {
  const Across across(e.direction);
  const Grid grid(k, n);
  return {e.point + grid.a * across.a + grid.b * across.b, e.direction};
}

PatternTouch on_line(const Element& e, int k, int n) {
  const double half = e.end > e.begin ? e.end : kPatternReach_mm;
  return {e.point + half * spread_evenly(k, n) * e.direction, e.second};
}

PatternTouch on_circle(const Element& e, int k, int n) {
  const Vec3 out = Across(e.direction).at(2 * kPi * k / n);
  return {e.point + e.size * out, out};
}

PatternTouch on_arc(const Element& e, int k, int n) {
  const Vec3 out = rotation(e.direction, e.angle * 0.5 * (spread_evenly(k, n) + 1)) * e.second;
  return {e.point + e.size * out, out};
}

/// Sections at equal distances, two of fewer than 12 touches, else three; every other one turned by a quarter
/// of a step.
PatternTouch on_cylinder(const Element& e, int k, int n) {
  const int sections = n < 12 ? 2 : 3, section = k % sections, in_section = (n - section + sections - 1) / sections;
  const double low = e.end > e.begin ? e.begin : -kPatternReach_mm,
               length = e.end > e.begin ? e.end - e.begin : 2 * kPatternReach_mm;
  const double height = low + length * (0.1 + 0.8 * section / (sections - 1));
  const Vec3 out = Across(e.direction).at(2 * kPi * (k / sections + 0.25 * (section % 2)) / in_section);
  return {e.point + height * e.direction + e.size * out, out};
}

/// The pole on the side of z (of -z inside), the others by turns on the circles at 0 and 45 degrees.
PatternTouch on_sphere(const Element& e, bool inner, int k, int n) {
  const double up = inner ? -1 : 1;
  Vec3 out{0, 0, up};
  if (k > 0) {
    const int circles = n < 9 ? 1 : 2, circle = (k - 1) % circles, on_this = (n - 1 - circle + circles - 1) / circles;
    const double angle = 2 * kPi * ((k - 1) / circles + 0.5 * circle) / on_this, rise = circle * kPi / 4;
    out = {std::cos(rise) * std::cos(angle), std::cos(rise) * std::sin(angle), up * std::sin(rise)};
  }
  return {e.point + e.size * out, out};
}

/// By turns on three circles of the half of the tube that the axis points out of: its ridge, its outside and
/// its inside. The inside is turned by half a step, so that seven touches, three of them on the ridge,
/// determine the torus.
PatternTouch on_torus(const Element& e, int k, int n) {
  const int circle = k % 3, on_this = (n - circle + 2) / 3;
  const Vec3 away = Across(e.direction).at(2 * kPi * (k / 3 + (circle == 2 ? 0.5 : 0)) / on_this);
  const Vec3 out = circle == 0 ? e.direction : circle == 1 ? away : -away;
  return {e.point + e.size * away + e.minor_size * out, out};
}

PatternTouch on_ellipse(const Element& e, int k, int n) {
  const double angle = 2 * kPi * k / n, c = std::cos(angle), s = std::sin(angle);
  const Vec3 across = cross(e.direction, e.second);
  return {e.point + e.size * c * e.second + e.minor_size * s * across,
          unit(c / e.size * e.second + s / e.minor_size * across)};
}

/// By turns on one long side, the other, one end, the other; evenly spaced within each.
PatternTouch on_sides(Shape shape, const Element& e, int k, int n) {
  const int side = k % 4, on_this = (n - side + 3) / 4;
  const double along = 2.0 * (k / 4 + 1) / (on_this + 1) - 1, sign = side % 2 ? -1 : 1;
  const Vec3 across = cross(e.direction, e.second);
  const bool round = shape == Shape::slot && e.angle == 0;
  const double straight = round ? e.size - e.minor_size : e.size;
  if (side < 2) return {e.point + along * straight * e.second + sign * e.minor_size * across, sign * across};
  if (!round) return {e.point + sign * e.size * e.second + along * e.minor_size * across, sign * e.second};
  const double angle = along * kPi / 2;
  const Vec3 out = sign * std::cos(angle) * e.second + std::sin(angle) * across;
  return {e.point + sign * straight * e.second + e.minor_size * out, out};
}

/// By turns on the two faces, on each as on a plane.
PatternTouch on_faces(const Element& e, int k, int n) {
  const double sign = k % 2 ? -1 : 1;
  const Grid grid(k / 2, (n + 1 - k % 2) / 2);
  // Crosswise, so that two touches on each face settle the normal.
  const Across across(e.direction);
  const Vec3 there = k % 2 ? grid.b * across.a + grid.a * across.b : grid.a * across.a + grid.b * across.b;
  return {e.point + there + sign * e.size * e.direction, sign * e.direction};
}

}  // namespace

Outcome<PatternTouch> pattern_touch(Shape shape, const Element& e, bool inner, int index, int count) {
  PatternTouch touch;
  switch (shape) {
    case Shape::point:
    case Shape::edge_point: return {{e.point, e.direction}};
    case Shape::plane: return {on_plane(e, index, count)};
    case Shape::line:
      if (!(norm(e.second) > 0))
        return Outcome<PatternTouch>::failed("the nominal line has no surface normal to touch along");
      return {on_line(e, index, count)};
    case Shape::circle: touch = on_circle(e, index, count); break;
    case Shape::arc: touch = on_arc(e, index, count); break;
    case Shape::cylinder: touch = on_cylinder(e, index, count); break;
    case Shape::sphere: touch = on_sphere(e, inner, index, count); break;
    case Shape::torus: touch = on_torus(e, index, count); break;
    case Shape::ellipse: touch = on_ellipse(e, index, count); break;
    case Shape::slot:
    case Shape::rectangle: touch = on_sides(shape, e, index, count); break;
    case Shape::parallel_planes:
    case Shape::symmetry_plane: touch = on_faces(e, index, count); break;
    case Shape::cone:
    case Shape::surface:
      return Outcome<PatternTouch>::failed("its nominal does not say where its surface begins and ends");
  }
  if (inner) touch.normal = -touch.normal;
  return {touch};
}

int pattern_minimum(Shape shape) { return shape == Shape::cylinder ? 6 : feature_kind(shape).minimum_points; }

std::string_view pattern_help(Shape shape) {
  switch (shape) {
    case Shape::point:
    case Shape::edge_point: return "every touch at the point";
    case Shape::plane: return "rows over a square of 20 mm about the point, along x and y of the system";
    case Shape::line: return "evenly from end to end; unbounded: over 20 mm about the point";
    case Shape::circle: return "evenly round, the first in the direction of x";
    case Shape::arc: return "evenly from its start to its end";
    case Shape::cylinder:
      return "two sections, three from 12 touches on, evenly round, every other one turned by a quarter of a step; from 10 % to 90 % of the "
             "length, or of 20 mm about the point";
    case Shape::sphere:
      return "one at the pole (z, inside -z), the others evenly round the equator; from 9 touches on also at 45 degrees";
    case Shape::torus:
      return "by turns on the ridge of the tube (where its axis points), on its outside and its inside, evenly round, the inside turned by half a step";
    case Shape::ellipse: return "round it at equal steps of its parameter, the first on the major axis";
    case Shape::slot:
    case Shape::rectangle: return "by turns on the two long sides and the two ends, evenly within each";
    case Shape::parallel_planes:
    case Shape::symmetry_plane: return "by turns on the two faces, on each as on a plane";
    case Shape::cone:
    case Shape::surface: return "";
  }
  return "";
}

}  // namespace abbe
