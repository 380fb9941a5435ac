// MOVEPT: the point of a feature, moved by a vector in the current coordinate system, or by a
// distance along the direction of another feature. OFFSET: a plane moved along its normal.
#include "engine/features/constructions/tools.hpp"

namespace abbe {
namespace {

const char* move_point_applies(Shape result, Shapes shapes) {
  if (result != Shape::point) return "MOVEPT makes a point";
  if (shapes.size() == 2 && shapes[1] == Shape::sphere) return "a sphere has no direction along which to move";
  return nullptr;
}

Outcome<Element> move_point(Shape, Shapes shapes, Elements from, const Element& nominal, const Arguments& arguments) {
  Vec3 by{arguments.number("dx"), arguments.number("dy"), arguments.number("dz")};
  if (from.size() == 2) by = arguments.number("distance") * from[1].direction;
  return {{.point = location_of(shapes[0], from[0]) + by, .direction = nominal.direction}};
}

const char* offset_applies(Shape result, Shapes shapes) {
  const bool fits = result == Shape::plane && shapes[0] == Shape::plane;
  return fits ? nullptr : "OFFSET makes a plane of a plane";
}

Outcome<Element> offset(Shape, Shapes, Elements from, const Element& nominal, const Arguments& arguments) {
  Element moved = from[0];
  moved.point += arguments.number("distance") * moved.direction;
  moved.low = moved.high = 0;
  return {in_sense_of(nominal, moved)};
}

}  // namespace

extern const Construction moved_point_method{
    .word = "MOVEPT",
    .signature = "from:feature,( from:feature,distance:length ; dx:length,dy:length,dz:length )",
    .help =
        "the point of a feature moved by dx, dy, dz, or by a distance along the direction of a "
        "second feature",
    .example = "CONST/POINT,F(P),MOVEPT,FA(A),10,0,-5",
    .source = "ISO 22093:2011, CONST MOVEPT",
    .applies = move_point_applies,
    .construct = move_point,
};

extern const Construction offset_plane_method{
    .word = "OFFSET",
    .signature = "from:feature,distance:length",
    .help = "a plane moved along its normal",
    .example = "CONST/PLANE,F(P2),OFFSET,FA(P1),-30",
    .source = "ISO 22093:2011, CONST OFFSET",
    .applies = offset_applies,
    .construct = offset,
};

}  // namespace abbe
