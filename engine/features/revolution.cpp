#include "engine/features/revolution.hpp"

#include "engine/features/solve.hpp"

namespace abbe {

Placed<double> placed(Shape shape, const Element& e, const Vec3& origin) {
  Placed<double> s;
  const Vec3 p = e.point - origin, x = any_perpendicular(e.direction);
  for (int k = 0; k < 3; ++k) s.p[k] = p[k], s.axes[0][k] = x[k];
  const double z[3] = {e.direction.x, e.direction.y, e.direction.z};
  point_axis(s, z);
  s.size[0] = shape == Shape::cone ? e.size * std::cos(e.angle) : e.size;
  s.size[1] = shape == Shape::cone ? e.angle : e.minor_size;
  return s;
}

Element turned_to(Shape shape, Element e, const Vec3& direction) {
  if (shape == Shape::cone || !(dot(e.direction, direction) < 0)) return e;
  e.direction = -e.direction;
  const double begin = e.begin, low = e.low;
  e.begin = -e.end, e.end = -begin;
  if (shape == Shape::plane) e.low = -e.high, e.high = -low;
  return e;
}

}  // namespace abbe
