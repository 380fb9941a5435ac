// MIDPT, MIDLI, MIDPL: halfway between two features.
//
// Of the two bisectors of a pair of lines or planes the one in the acute angle is meant; where they
// cross at 45 degrees or more, the one nearer to the nominal. It is found where both are cut by
// what stands across the bisector (or runs along it) through the middle of their points, which
// needs no intersection and so holds for parallel pairs too.
#include <cmath>

#include "engine/features/constructions/tools.hpp"

namespace abbe {
namespace {

/// Unit vector halfway between the directions a and b, up to sense.
Vec3 bisector(const Vec3& a, const Vec3& b, const Vec3& nominal) {
  const double cosine = dot(a, b);
  bool same = cosine > 0;
  if (std::fabs(cosine) < std::sqrt(0.5))
    same = std::fabs(dot(unit(a + b), nominal)) >= std::fabs(dot(unit(a - b), nominal));
  return unit(same ? a + b : a - b);
}

const char* middle_point_applies(Shape result, Shapes) {
  return result == Shape::point ? nullptr : "MIDPT makes a point";
}

Outcome<Element> middle_point(Shape, Shapes shapes, Elements from, const Element& nominal, const Arguments&) {
  return {{.point = 0.5 * (location_of(shapes[0], from[0]) + location_of(shapes[1], from[1])),
           .direction = nominal.direction}};
}

const char* middle_line_applies(Shape result, Shapes shapes) {
  const bool fits = result == Shape::line && has_axis(shapes[0]) && has_axis(shapes[1]);
  return fits ? nullptr : "MIDLI makes a line of two lines or axes";
}

Outcome<Element> middle_line(Shape, Shapes, Elements from, const Element& nominal, const Arguments&) {
  const Vec3 d = bisector(from[0].direction, from[1].direction, nominal.direction);
  const Element across{.point = 0.5 * (from[0].point + from[1].point), .direction = d};
  const Vec3 a = line_meets_plane(from[0].point, from[0].direction, across);
  const Vec3 b = line_meets_plane(from[1].point, from[1].direction, across);
  return {in_sense_of(nominal, {.point = 0.5 * (a + b), .direction = d})};
}

const char* middle_plane_applies(Shape result, Shapes shapes) {
  const bool fits = result == Shape::plane && shapes[0] == Shape::plane && shapes[1] == Shape::plane;
  return fits ? nullptr : "MIDPL makes a plane of two planes";
}

Outcome<Element> middle_plane(Shape, Shapes, Elements from, const Element& nominal, const Arguments&) {
  const Vec3 n = bisector(from[0].direction, from[1].direction, nominal.direction);
  const Vec3 middle = 0.5 * (from[0].point + from[1].point);
  const Vec3 point = 0.5 * (line_meets_plane(middle, n, from[0]) + line_meets_plane(middle, n, from[1]));
  return {in_sense_of(nominal, {.point = point, .direction = n})};
}

}  // namespace

extern const Construction mid_point_method{
    .word = "MIDPT",
    .signature = "from:feature,from:feature",
    .help = "the point halfway between the points or centres of two features",
    .example = "CONST/POINT,F(P),MIDPT,FA(A),FA(B)",
    .source = "ISO 22093:2011, CONST MIDPT",
    .applies = middle_point_applies,
    .construct = middle_point,
};

extern const Construction mid_line_method{
    .word = "MIDLI",
    .signature = "from:feature,from:feature",
    .help = "the line halfway between two lines or axes",
    .example = "CONST/LINE,F(L),MIDLI,FA(A),FA(B)",
    .source = "ISO 22093:2011, CONST MIDLI",
    .applies = middle_line_applies,
    .construct = middle_line,
};

extern const Construction mid_plane_method{
    .word = "MIDPL",
    .signature = "from:feature,from:feature",
    .help = "the plane halfway between two planes",
    .example = "CONST/PLANE,F(P),MIDPL,FA(A),FA(B)",
    .source = "ISO 22093:2011, CONST MIDPL",
    .applies = middle_plane_applies,
    .construct = middle_plane,
    .lies_between = true,
};

}  // namespace abbe
