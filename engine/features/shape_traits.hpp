// Which parts of an Element mean something for which shape.
#pragma once

#include <cmath>

#include "engine/features/feature.hpp"

namespace abbe {

inline Shape acts_as(Shape s) { return feature_kind(s).acts_as; }

/// The sine up to which directions that are written with few decimals, or were measured, are meant as parallel or at
/// right angles: 1 degree.
inline constexpr double kOneDegreeSine = 0.0175;

/// Slots, rectangles and ellipses: curves in a plane, with a centre and a long side.
constexpr bool is_outline(Shape s) { return s == Shape::slot || s == Shape::rectangle || s == Shape::ellipse; }

/// Those whose size is the radius of a circle or a sphere, wherever it is measured.
constexpr bool has_diameter(Shape s) { return s == Shape::circle || s == Shape::cylinder || s == Shape::sphere; }

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

/// The point by which FEAT says where a feature is. Of a cone that is the apex: Element::point is where it was touched.
inline Vec3 location_of(Shape shape, const Element& e) { return shape == Shape::cone ? apex(e) : e.point; }

}  // namespace abbe
