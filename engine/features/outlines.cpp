// CPARLN, RCTNGL and ELLIPS. A slot with flat ends keeps that in Element::angle, which is 1 for it and 0
// for round ends.
#include <algorithm>
#include <cmath>

#include "engine/features/nominal.hpp"
#include "engine/features/outline.hpp"
#include "engine/features/pattern.hpp"
#include "engine/features/shape_traits.hpp"

namespace abbe {
namespace {

/// (i, j, k) with a suffix as a unit vector, zero when it has no length.
Vec3 vector_of(const Arguments& arguments, const std::string& suffix) {
  const Vec3 v{arguments.number("i" + suffix), arguments.number("j" + suffix), arguments.number("k" + suffix)};
  const double length = norm(v);
  return length > 0 && std::isfinite(length) ? v / length : Vec3{};
}

/// The outline through its centre across `normal`, `along` turned exactly square to it.
Outcome<Element> outline(const Vec3& centre, const Vec3& normal, const Vec3& along, double length, double width) {
  using Made = Outcome<Element>;
  if (norm(normal) == 0 || norm(along) == 0) return Made::failed("a direction vector has no length");
  if (std::fabs(dot(normal, along)) > kOneDegreeSine)
    return Made::failed("its direction must lie across the normal of its plane");
  if (!(length > 0 && width > 0)) return Made::failed("its length and width must be positive");
  return {{.point = centre,
           .direction = normal,
           .size = length / 2,
           .minor_size = width / 2,
           .second = unit(perpendicular_part(along, normal))}};
}

Outcome<Element> slot(const Arguments& arguments) {
  Outcome<Element> made = outline(location(arguments), vector_of(arguments, ""), vector_of(arguments, "2"),
                                  arguments.number("length"), arguments.number("width"));
  made.value.angle = arguments.text("ends") == "FLAT" ? 1 : 0;
  if (made && !(made.value.size > made.value.minor_size)) return Outcome<Element>::failed("a slot is longer than wide");
  return made;
}

Outcome<Element> rectangle(const Arguments& arguments) {
  Outcome<Element> made = outline(location(arguments), vector_of(arguments, "3"), vector_of(arguments, "1"),
                                  arguments.number("len1"), arguments.number("len2"));
  const Vec3 other = vector_of(arguments, "2");
  const auto square_to = [&](const Vec3& v) { return std::fabs(dot(other, v)) <= kOneDegreeSine; };
  if (made && !(norm(other) > 0 && square_to(made.value.direction) && square_to(made.value.second)))
    return Outcome<Element>::failed("its three directions must be at right angles");
  made.value.end = arguments.number("len3") / 2, made.value.begin = -made.value.end;
  return made;
}

/// From the two foci and the diameter along the major or the minor axis.
Outcome<Element> ellipse(const Arguments& arguments) {
  const Vec3 f1{arguments.number("x1"), arguments.number("y1"), arguments.number("z1")};
  const Vec3 f2{arguments.number("x2"), arguments.number("y2"), arguments.number("z2")};
  const double c = 0.5 * norm(f2 - f1), given = arguments.number("diam") / 2;
  if (!(c > 0)) return Outcome<Element>::failed("the two foci are the same point: that is a circle");
  const bool major = arguments.text("axis") == "MAJOR";
  if (major && !(given > c))
    return Outcome<Element>::failed("the major diameter must be longer than the distance of the foci");
  const double a = major ? given : std::sqrt(given * given + c * c);
  const double b = major ? std::sqrt(given * given - c * c) : given;
  return outline(0.5 * (f1 + f2), vector_of(arguments, ""), unit(f2 - f1), 2 * a, 2 * b);
}

Outcome<PatternTouch> touch_ellipse(const Element& e, bool, int k, int n) {
  const double angle = 2 * kPi * k / n, c = std::cos(angle), s = std::sin(angle);
  const Vec3 across = cross(e.direction, e.second);
  return {{e.point + e.size * c * e.second + e.minor_size * s * across,
           unit(c / e.size * e.second + s / e.minor_size * across)}};
}

/// By turns on one long side, the other, one end, the other; evenly spaced within each.
template <Shape shape>
Outcome<PatternTouch> touch_sides(const Element& e, bool, int k, int n) {
  const int side = k % 4, on_this = (n - side + 3) / 4;
  const double along = 2.0 * (k / 4 + 1) / (on_this + 1) - 1, sign = side % 2 ? -1 : 1;
  const Vec3 across = cross(e.direction, e.second);
  const bool round = shape == Shape::slot && e.angle == 0;
  const double straight = round ? e.size - e.minor_size : e.size;
  if (side < 2) return {{e.point + along * straight * e.second + sign * e.minor_size * across, sign * across}};
  if (!round) return {{e.point + sign * e.size * e.second + along * e.minor_size * across, sign * e.second}};
  const double angle = along * kPi / 2;
  const Vec3 out = sign * std::cos(angle) * e.second + std::sin(angle) * across;
  return {{e.point + sign * straight * e.second + e.minor_size * out, out}};
}

/// Away from the outline, in its plane.
template <Shape shape>
Outcome<Vec3> outline_normal(const Element& e, const Vec3& point) {
  const Vec3 across = cross(e.direction, e.second), w = point - e.point;
  const OutlineDistance o =
      outline_distance(shape, e.angle != 0, dot(w, e.second), dot(w, across), e.size, e.minor_size);
  return {o.nu * e.second + o.nv * across};
}

FeatArguments written_slot(const Element& e) {
  return {e.angle != 0 ? "FLAT" : "ROUND", "CART", e.point, e.direction, e.second, 2 * e.size, 2 * e.minor_size};
}

FeatArguments written_rectangle(const Element& e) {
  const Vec3 across = cross(e.direction, e.second);
  return {"CART", e.point, e.second, 2 * e.size, across, 2 * e.minor_size, e.direction, e.end - e.begin};
}

FeatArguments written_ellipse(const Element& e) {
  const Vec3 focus = std::sqrt(std::max(0.0, e.size * e.size - e.minor_size * e.minor_size)) * e.second;
  return {"CART", e.point - focus, e.point + focus, "MAJOR", 2 * e.size, e.direction};
}

}  // namespace

extern const FeatureKind slot_kind{
    .shape = Shape::slot,
    .flat = true,
    .word = "CPARLN",
    .signature = "side:INNER|OUTER,ends:ROUND|FLAT," ABBE_LOCATION "," ABBE_DIRECTION
                 ",i2:number,j2:number,k2:number,length:length,width:length",
    .help = "a slot or tongue: centre, normal of its plane, direction along it, length over all, width",
    .example = "F(SL1)=FEAT/CPARLN,INNER,ROUND,CART,40,30,-5,0,0,1,1,0,0,30,10",
    .source = "ISO 22093:2011, FEAT/CPARLN; orthogonal least squares in the plane of the nominal normal",
    .nominal = slot,
    .written = written_slot,
    .normal = outline_normal<Shape::slot>,
    .pattern = {.help = "by turns on the two long sides and the two ends, evenly within each",
                .touch = touch_sides<Shape::slot>},
    .minimum_points = 5,
    .fit_lanes = fit_outline_lanes<Shape::slot>,
};

extern const FeatureKind rectangle_kind{
    .shape = Shape::rectangle,
    .flat = true,
    .word = "RCTNGL",
    .signature =
        "side:INNER|OUTER," ABBE_LOCATION
        ",i1:number,j1:number,k1:number,len1:length,i2:number,j2:number,k2:number,len2:length,i3:number,j3:number,k3:number,"
        "len3:length",
    .help = "a block: centre, three directions and lengths; the four sides across the first two are measured",
    .example = "F(RE1)=FEAT/RCTNGL,OUTER,CART,0,0,0,1,0,0,60,0,1,0,40,0,0,1,20",
    .source = "ISO 22093:2011, FEAT/RCTNGL; least squares of the four sides across the third direction",
    .nominal = rectangle,
    .written = written_rectangle,
    .normal = outline_normal<Shape::rectangle>,
    .pattern = {.help = "by turns on the two long sides and the two ends, evenly within each",
                .touch = touch_sides<Shape::rectangle>},
    .minimum_points = 5,
    .fit_lanes = fit_outline_lanes<Shape::rectangle>,
};

extern const FeatureKind ellipse_kind{
    .shape = Shape::ellipse,
    .word = "ELLIPS",
    .signature =
        "side:INNER|OUTER,CART,x1:length,y1:length,z1:length,x2:length,y2:length,z2:length,axis:MAJOR|MINOR,diam:length," ABBE_DIRECTION,
    .help = "an ellipse: its two foci, the diameter along its major or minor axis, normal of its plane",
    .example = "F(EL1)=FEAT/ELLIPS,INNER,CART,-30,0,0,30,0,0,MAJOR,100,0,0,1",
    .source = "ISO 22093:2011, FEAT/ELLIPS; orthogonal least squares in the plane of the nominal normal",
    .nominal = ellipse,
    .written = written_ellipse,
    .normal = outline_normal<Shape::ellipse>,
    .pattern = {.help = "round it at equal steps of its parameter, the first on the major axis",
                .touch = touch_ellipse},
    .minimum_points = 5,
    .fit_lanes = fit_outline_lanes<Shape::ellipse>,
};

}  // namespace abbe
