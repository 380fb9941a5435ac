// Which parts of an Element mean something for which shape.
#pragma once

#include "engine/features/element.hpp"

namespace abbe {

/// The kind that a feature of this shape is treated as where only its point, direction and size matter:
/// in constructions, alignments and as a datum.
constexpr Shape acts_as(Shape s) { return s; }

/// Points and spheres: an Element whose direction says nothing about how the feature lies.
constexpr bool is_spot(Shape s) { return s == Shape::point || s == Shape::sphere; }
constexpr bool has_axis(Shape s) {
  return s == Shape::line || s == Shape::cylinder || s == Shape::cone || s == Shape::torus;
}
constexpr bool has_centre(Shape s) {
  return s == Shape::point || s == Shape::circle || s == Shape::sphere || s == Shape::torus;
}

}  // namespace abbe
