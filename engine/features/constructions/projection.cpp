// PROJPT, PROJLI: the foot of a point on a plane or an axis, the shadow of a line on a plane.
#include "engine/features/constructions/tools.hpp"

namespace abbe {
namespace {

const char* project_point_applies(Shape result, Shapes shapes) {
  if (result != Shape::point) return "PROJPT makes a point";
  const bool fits = shapes[1] == Shape::plane || has_axis(shapes[1]);
  return fits ? nullptr : "PROJPT projects onto a plane, a line or an axis";
}

Outcome<Element> project_point(Shape, Shapes shapes, Elements from, const Element& nominal, const Arguments&) {
  const Element& onto = from[1];
  const Vec3 point = location_of(shapes[0], from[0]);
  if (shapes[1] == Shape::plane)
    return {{.point = foot_on_plane(onto.point, onto.direction, point), .direction = onto.direction}};
  return {{.point = foot_on_line(onto.point, onto.direction, point), .direction = nominal.direction}};
}

const char* project_line_applies(Shape result, Shapes shapes) {
  const bool fits = result == Shape::line && has_axis(shapes[0]) && shapes[1] == Shape::plane;
  return fits ? nullptr : "PROJLI projects a line or an axis onto a plane";
}

Outcome<Element> project_line(Shape, Shapes, Elements from, const Element& nominal, const Arguments&) {
  const Element &line = from[0], &plane = from[1];
  const Vec3 shadow = perpendicular_part(line.direction, plane.direction);
  const double cosine = norm(shadow);
  if (cosine < kParallel) return cannot("the line is perpendicular to the plane");
  return {in_sense_of(nominal,
                      {.point = foot_on_plane(plane.point, plane.direction, line.point),
                       .direction = shadow / cosine,
                       .begin = line.begin * cosine,
                       .end = line.end * cosine})};
}

}  // namespace

extern const Construction projected_point_method{
    .word = "PROJPT",
    .signature = "from:feature,from:feature",
    .help = "the point or centre of the first feature, projected onto the plane or axis of the second",
    .example = "CONST/POINT,F(P),PROJPT,FA(A),FA(PL)",
    .source = "ISO 22093:2011, CONST PROJPT",
    .applies = project_point_applies,
    .construct = project_point,
};

extern const Construction projected_line_method{
    .word = "PROJLI",
    .signature = "from:feature,from:feature",
    .help = "a line or axis projected onto a plane",
    .example = "CONST/LINE,F(L),PROJLI,FA(A),FA(PL)",
    .source = "ISO 22093:2011, CONST PROJLI",
    .applies = project_line_applies,
    .construct = project_line,
};

}  // namespace abbe
