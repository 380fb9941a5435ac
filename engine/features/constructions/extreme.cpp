// EXTREM: the point of a feature that lies farthest along a direction (MAX) or against it (MIN). It is
// the point of the fitted element, over the extent of its touches: an axis and a line reach to their
// measured ends, a plane as a disc about the middle of its touches to the distance of the outermost one.
// A plane that lies across the direction has no such point: where it leans is chance.
#include <cmath>

#include "engine/base/ids.hpp"
#include "engine/features/constructions/tools.hpp"

namespace abbe {
namespace {

Vec3 direction_of(const Arguments& arguments) {
  const std::string word = arguments.text("along");
  if (!word.empty()) return {word[0] == 'X' ? 1.0 : 0.0, word[0] == 'Y' ? 1.0 : 0.0, word[0] == 'Z' ? 1.0 : 0.0};
  return {arguments.number("i"), arguments.number("j"), arguments.number("k")};
}

/// From the point of the feature to its farthest point along the unit vector e.
Vec3 farthest(Shape shape, const Element& f, const Vec3& e) {
  const Vec3 across = perpendicular_part(e, f.direction);
  const Vec3 out = norm(across) > kParallel ? unit(across) : Vec3{};
  const double end = dot(e, f.direction) < 0 ? f.begin : f.end;
  switch (shape) {
    case Shape::point: return {};
    case Shape::sphere: return f.size * e;
    case Shape::circle: return f.size * out;
    case Shape::plane: return f.end * out;
    case Shape::line: return end * f.direction;
    case Shape::cylinder: return end * f.direction + f.size * out;
    case Shape::torus: return f.size * out + f.minor_size * e;
    default: ABBE_CHECK(false);
  }
}

const char* extreme_applies(Shape result, Shapes shapes) {
  if (result != Shape::point) return "EXTREM makes a point";
  const Shape s = shapes[0];
  const bool known = is_spot(s) || s == Shape::plane || s == Shape::circle || (has_axis(s) && s != Shape::cone);
  return known ? nullptr : "EXTREM takes points, lines, planes, circles, cylinders, spheres and tori";
}

Outcome<Element> extreme(Shape, Shapes shapes, Elements from, const Element& nominal, const Arguments& arguments) {
  const Vec3 along = direction_of(arguments);
  if (!(norm(along) > 0)) return cannot("the direction of EXTREM has no length");
  const Vec3 e = arguments.text("end") == "MAX" ? unit(along) : -unit(along);
  if (shapes[0] == Shape::plane && norm(cross(e, from[0].direction)) < kOneDegreeSine)
    return cannot("the plane lies across the direction of EXTREM, so that no point of it is farther than the others");
  const Vec3 there = farthest(shapes[0], from[0], e);
  return {{.point = from[0].point + there, .direction = nominal.direction}};
}

}  // namespace

extern const Construction extreme_method{
    .word = "EXTREM",
    .signature = "end:MIN|MAX,from:feature,( along:XDIR|YDIR|ZDIR ; [ VEC ],i:number,j:number,k:number )",
    .help = "the point of a feature that lies farthest along (MAX) or against (MIN) a direction",
    .example = "CONST/POINT,F(P),EXTREM,MAX,FA(C),ZDIR",
    .source = "ISO 22093:2011, CONST EXTREM",
    .applies = extreme_applies,
    .construct = extreme,
};

}  // namespace abbe
