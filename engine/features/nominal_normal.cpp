#include "engine/features/nominal_normal.hpp"

#include <cmath>

#include "engine/features/outline.hpp"
#include "engine/features/shape_traits.hpp"

namespace abbe {
namespace {

using Normal = Outcome<Vec3>;

/// Away from the outline, in its plane.
Vec3 out_of_outline(Shape shape, const Element& e, const Vec3& point) {
  const Vec3 across = cross(e.direction, e.second), w = point - e.point;
  const OutlineDistance o =
      outline_distance(shape, e.angle != 0, dot(w, e.second), dot(w, across), e.size, e.minor_size);
  return o.nu * e.second + o.nv * across;
}

Normal out_of_round(Shape shape, const Element& e, const Vec3& point) {
  Vec3 out = point - e.point;
  if (shape != Shape::sphere) out = perpendicular_part(out, e.direction);
  if (norm(out) == 0) return Normal::failed("the point lies on the axis of the feature: give the vector in PTMEAS");
  out = unit(out);
  return {shape == Shape::cone ? std::cos(e.angle) * out - std::sin(e.angle) * e.direction : out};
}

/// Away from the nearest point of the centre line of the tube.
Normal out_of_tube(const Element& e, const Vec3& point) {
  const Vec3 across = perpendicular_part(point - e.point, e.direction);
  if (norm(across) == 0) return Normal::failed("the point lies on the axis of the torus: give the vector in PTMEAS");
  const Vec3 out = point - (e.point + e.size * unit(across));
  if (norm(out) == 0) return Normal::failed("the point lies in the middle of the tube: give the vector in PTMEAS");
  return {unit(out)};
}

}  // namespace

Outcome<Vec3> nominal_normal(Shape shape, const Element& nominal, bool inner, const Vec3& point) {
  Normal out;
  switch (shape) {
    case Shape::point:
    case Shape::plane:
    case Shape::edge_point: return {nominal.direction};
    case Shape::line:
      if (norm(nominal.second) > 0) return {nominal.second};
      return Normal::failed("a touch on a line needs the vector of the surface in PTMEAS");
    case Shape::surface: return Normal::failed("a touch on a GSURF needs the vector of the surface in PTMEAS");
    case Shape::slot:
    case Shape::rectangle:
    case Shape::ellipse: out = {out_of_outline(shape, nominal, point)}; break;
    case Shape::torus: out = out_of_tube(nominal, point); break;
    case Shape::parallel_planes:
    case Shape::symmetry_plane:
      out = {dot(point - nominal.point, nominal.direction) < 0 ? -nominal.direction : nominal.direction};
      break;
    case Shape::circle:
    case Shape::arc:
    case Shape::cylinder:
    case Shape::sphere:
    case Shape::cone: out = out_of_round(shape, nominal, point); break;
  }
  return out ? Normal{inner ? -out.value : out.value} : out;
}

}  // namespace abbe
