// CONE: the circle in which a cone is cut across its axis, where it has a given diameter (a gauge
// diameter, whose place is a depth or a height) or at a given distance from its apex along the axis.
#include <cmath>

#include "engine/features/constructions/tools.hpp"

namespace abbe {
namespace {

const char* cone_section_applies(Shape result, Shapes shapes) {
  return result == Shape::circle && shapes[0] == Shape::cone ? nullptr : "CONE makes a circle of a cone";
}

Outcome<Element> cone_section(Shape, Shapes, Elements from, const Element& nominal, const Arguments& arguments) {
  const Element& cone = from[0];
  const double slope = std::tan(cone.angle);
  const double radius =
      arguments.has("diameter") ? 0.5 * arguments.number("diameter") : arguments.number("distance") * slope;
  if (!(radius > 0)) return cannot("the circle of a cone needs a diameter, or a distance from the apex, above 0");
  const Vec3 centre = apex(cone) + radius / slope * cone.direction;
  return {in_sense_of(nominal, {.point = centre, .direction = cone.direction, .size = radius})};
}

}  // namespace

extern const Construction cone_section_method{
    .word = "CONE",
    .signature = "( DIAM,diameter:length ; DIST,distance:length ),from:feature",
    .help = "the circle of a cone that has this diameter, or lies at this distance from the apex along the axis",
    .example = "CONST/CIRCLE,F(C),CONE,DIAM,12,FA(CO)",
    .source = "ISO 22093:2011, CONST CONE",
    .applies = cone_section_applies,
    .construct = cone_section,
};

}  // namespace abbe
