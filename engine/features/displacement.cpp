#include "engine/features/displacement.hpp"

#include <cmath>

#include "engine/features/shape_traits.hpp"

namespace abbe {

Vec3 displacement(Shape shape, const Element& actual, const Element& nominal) {
  const Vec3 between = actual.point - nominal.point;
  const double along = dot(actual.direction, nominal.direction);
  const Shape acts = acts_as(shape);
  const bool plane = acts == Shape::plane, axis = acts == Shape::line || acts == Shape::cylinder || acts == Shape::cone;
  if (!plane && !axis) return between;
  constexpr double kSquare = 1e-6;
  if (std::fabs(along) < kSquare) return {};
  // Where the actual plane meets the nominal normal, or the actual axis the plane across the nominal one.
  if (plane) return dot(between, actual.direction) / along * nominal.direction;
  return between - dot(between, nominal.direction) / along * actual.direction;
}

}  // namespace abbe
