// Points on elements of every kind, with noise, for the tests of the fits. Random numbers from the engine's
// own generator.
#pragma once

#include <cstring>
#include <vector>

#include "engine/base/ids.hpp"
#include "engine/features/feature.hpp"
#include "engine/features/fit.hpp"
#include "engine/lanes/random.hpp"

namespace abbe {

/// The n-th uniform random number of a named stream, in (0, 1).
inline double random_at(std::string_view stream, int n) {
  const Philox4 bits = random_bits({.stream = stream_of(stream), .site = static_cast<std::uint32_t>(n)});
  return uniform_from_bits(bits.v[0], bits.v[1]);
}

inline double between(std::string_view stream, int n, double low, double high) {
  return low + (high - low) * random_at(stream, n);
}

inline Element some_element(Shape shape) {
  Element e{.point = {120, -80, 45}, .direction = unit(Vec3{0.3, -0.5, 0.8}), .size = 20};
  if (shape == Shape::torus) e.size = 40, e.minor_size = 12;
  if (shape == Shape::cone) e.angle = 0.4;
  if (shape == Shape::line || shape == Shape::plane || shape == Shape::point) e.size = 0;
  return e;
}

/// Which part of an element is touched: turn about the axis (rad), length along it (mm), turn about the tube (rad).
struct Part {
  double turn = 2 * kPi, length = 30, tube = 2 * kPi;
};

/// Kinds that are fitted from the points alone; arcs are circles.
inline bool is_basic(const FeatureKind& kind) { return kind.fit_points && kind.shape != Shape::arc; }

/// The point of the surface with parameters u, v in (0, 1), displaced by `out` mm along the normal.
inline Vec3 surface_point(const Element& e, Shape shape, double u, double v, double out, const Part& part = {}) {
  const Vec3 z = e.direction, x = any_perpendicular(z), y = cross(z, x);
  const double turn = part.turn * u, h = part.length * (v - 0.5);
  const Vec3 radial = std::cos(turn) * x + std::sin(turn) * y;
  switch (shape) {
    case Shape::point: return e.point + out * z;
    case Shape::line: return e.point + part.length * (u - 0.5) * z + out * radial;
    case Shape::plane: return e.point + part.length * ((u - 0.5) * x + (v - 0.5) * y) + out * z;
    case Shape::arc:
    case Shape::circle: return e.point + (e.size + out) * radial;
    case Shape::cylinder: return e.point + h * z + (e.size + out) * radial;
    case Shape::sphere: {
      const double c = 2 * v - 1, s = std::sqrt(1 - c * c);
      return e.point + (e.size + out) * (c * z + s * radial);
    }
    case Shape::cone: {
      const Vec3 normal = std::cos(e.angle) * radial - std::sin(e.angle) * z;
      return e.point + h * z + (e.size + h * std::tan(e.angle)) * radial + out * normal;
    }
    case Shape::torus: {
      const double tube = part.tube * (v - 0.5);
      return e.point + e.size * radial + (e.minor_size + out) * (std::cos(tube) * radial + std::sin(tube) * z);
    }
    default: break;
  }
  throw InternalError("a Shape without a surface");
}

/// Points of `lanes` machines on one element.
struct Batch {
  int points = 0, lanes = 0;
  std::vector<double> data;
  PointColumns columns() const { return {data.data(), points, lanes, lanes}; }
  void set(int touch, int k, int lane, double value) { data[(3 * touch + k) * lanes + lane] = value; }
  std::vector<Vec3> lane(int l) const {
    std::vector<Vec3> list;
    for (int t = 0; t < points; ++t) list.push_back(columns().at(t, l));
    return list;
  }
  Batch part(int first, int count) const {
    Batch b{points, count, std::vector<double>(3 * points * count)};
    for (int row = 0; row < 3 * points; ++row)
      for (int l = 0; l < count; ++l) b.data[row * count + l] = data[row * lanes + first + l];
    return b;
  }
};

/// The same nominal touches for all lanes, each lane with noise of up to +-`noise` mm along the normal.
inline Batch some_batch(const Element& e, Shape shape, int points, int lanes, double noise) {
  Batch b{points, lanes, std::vector<double>(3 * points * lanes)};
  for (int t = 0; t < points; ++t)
    for (int l = 0; l < lanes; ++l) {
      const double out = noise * (2 * random_at("noise", t * lanes + l) - 1);
      const Vec3 p = surface_point(e, shape, random_at("u", t), random_at("v", t), out);
      for (int k = 0; k < 3; ++k) b.set(t, k, l, p[k]);
    }
  return b;
}

struct BatchFit {
  std::vector<Element> element;
  std::vector<const char*> failure;
};

inline BatchFit fit_batch(const FeatureKind& kind, const Batch& batch, const Element& start) {
  BatchFit fitted{std::vector<Element>(batch.lanes), std::vector<const char*>(batch.lanes)};
  const std::vector<Element> from(batch.lanes, start);
  kind.fit_lanes(batch.columns(), from.data(), fitted.element.data(), fitted.failure.data());
  return fitted;
}

inline bool same_bits(const Element& a, const Element& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

}  // namespace abbe
