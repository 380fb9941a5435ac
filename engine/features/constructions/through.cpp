// PERPTO and PARTO: a line or plane through the point of one feature, at a right angle or parallel
// to another.
//
// A line perpendicular to an axis through a point runs from the point to its foot on the axis; when
// the point lies on the axis there is no such foot and the construction fails. A plane
// perpendicular to a plane needs a direction to turn about, so its second feature must be a line or
// an axis: the plane contains it.
#include "engine/features/constructions/tools.hpp"

namespace abbe {
namespace {

constexpr double kNoDistance_mm = 1e-6;

Outcome<Element> made(const Element& nominal, const Vec3& point, const Vec3& direction) {
  return {in_sense_of(nominal, {.point = point, .direction = direction})};
}

const char* perpendicular_applies(Shape result, Shapes shapes) {
  const bool to_plane = shapes[0] == Shape::plane, to_axis = has_axis(shapes[0]);
  const bool line = result == Shape::line && (to_plane || to_axis);
  const bool plane = result == Shape::plane && (to_axis || (to_plane && has_axis(shapes[1])));
  return line || plane ? nullptr
                       : "PERPTO makes a line perpendicular to a plane or line, or a plane perpendicular "
                         "to a line, or to a plane through a line";
}

Outcome<Element> perpendicular(Shape result, Shapes shapes, Elements from, const Element& nominal, const Arguments&) {
  const Element& to = from[0];
  const Vec3 through = location_of(shapes[1], from[1]);
  const bool to_plane = shapes[0] == Shape::plane, to_axis = has_axis(shapes[0]);
  if ((result == Shape::line && to_plane) || (result == Shape::plane && to_axis))
    return made(nominal, through, to.direction);
  if (result == Shape::line) {
    const Vec3 across = foot_on_line(to.point, to.direction, through) - through;
    if (!(norm(across) > kNoDistance_mm))
      return cannot("the point lies on the line to which the new one should be perpendicular");
    return made(nominal, through, unit(across));
  }
  const Vec3 n = cross(to.direction, from[1].direction);
  if (norm(n) < kParallel) return cannot("the line is perpendicular to the plane, so that no single plane contains it");
  return made(nominal, through, unit(n));
}

const char* parallel_applies(Shape result, Shapes shapes) {
  const bool planes = result == Shape::plane && shapes[0] == Shape::plane;
  const bool lines = result == Shape::line && has_axis(shapes[0]);
  return planes || lines ? nullptr : "PARTO makes a plane parallel to a plane or a line parallel to a line";
}

Outcome<Element> parallel_to(Shape, Shapes shapes, Elements from, const Element& nominal, const Arguments&) {
  return made(nominal, location_of(shapes[1], from[1]), from[0].direction);
}

}  // namespace

extern const Construction perpendicular_through_method{
    .word = "PERPTO",
    .signature = "from:feature,[THRU],from:feature",
    .help = "a line or plane perpendicular to the first feature through the second",
    .example = "CONST/LINE,F(L),PERPTO,FA(PL),THRU,FA(PT)",
    .source = "ISO 22093:2011, CONST PERPTO",
    .applies = perpendicular_applies,
    .construct = perpendicular,
};

extern const Construction parallel_through_method{
    .word = "PARTO",
    .signature = "from:feature,[THRU],from:feature",
    .help = "a line or plane parallel to the first feature through the second",
    .example = "CONST/PLANE,F(P2),PARTO,FA(P1),THRU,FA(PT)",
    .source = "ISO 22093:2011, CONST PARTO",
    .applies = parallel_applies,
    .construct = parallel_to,
};

}  // namespace abbe
