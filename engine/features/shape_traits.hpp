// Which parts of an Element mean something for which shape.
#pragma once

#include <cmath>

#include "engine/features/element.hpp"

namespace abbe {

/// The shape that a feature is treated as where only its point, direction and radius matter: in
/// constructions, alignments and tolerances of location. Pairs of planes are their median plane there.
constexpr Shape acts_as(Shape s) {
  switch (s) {
    case Shape::arc: return Shape::circle;
    case Shape::edge_point:
    case Shape::surface: return Shape::point;
    case Shape::parallel_planes:
    case Shape::symmetry_plane: return Shape::plane;
    default: return s;
  }
}

/// The sine up to which directions that are written with few decimals, or were measured, are meant as parallel or at
/// right angles: 1 degree.
inline constexpr double kOneDegreeSine = 0.0175;

/// Slots, rectangles and ellipses: curves in a plane, with a centre and a long side.
constexpr bool is_outline(Shape s) { return s == Shape::slot || s == Shape::rectangle || s == Shape::ellipse; }

/// Points and spheres: an Element whose direction says nothing about how the feature lies.
constexpr bool is_spot(Shape s) { return s == Shape::point || s == Shape::sphere; }
constexpr bool has_axis(Shape s) {
  return s == Shape::line || s == Shape::cylinder || s == Shape::cone || s == Shape::torus;
}
constexpr bool has_centre(Shape s) {
  return s == Shape::point || s == Shape::circle || s == Shape::sphere || s == Shape::torus || is_outline(s);
}

/// Where the radius of a cone is zero; a constructed cone without angle keeps its point.
inline Vec3 apex(const Element& cone) {
  return cone.angle > 0 ? cone.point - cone.size / std::tan(cone.angle) * cone.direction : cone.point;
}

}  // namespace abbe
