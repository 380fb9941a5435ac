// Features to construct others from, and places compared.
#pragma once

#include <doctest/doctest.h>

#include "engine/features/construct.hpp"

namespace abbe {

struct Operand {
  Shape shape;
  Element element;
};

inline Operand point(Vec3 at) { return {Shape::point, {.point = at}}; }
inline Operand line(Vec3 point, Vec3 along, double begin = 0, double end = 0) {
  return {Shape::line, {.point = point, .direction = unit(along), .begin = begin, .end = end}};
}

inline void check_near(const Vec3& a, const Vec3& b, double tolerance = 1e-12) {
  INFO(a.x, " ", a.y, " ", a.z, " expected ", b.x, " ", b.y, " ", b.z);
  CHECK(norm(a - b) <= tolerance);
}

}  // namespace abbe
