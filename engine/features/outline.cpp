#include "engine/features/outline.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/features/solve.hpp"
#include "engine/math/cholesky.hpp"

namespace abbe {
namespace {

double sign_of(double x) { return x < 0 ? -1 : 1; }

OutlineDistance flat(double u, double v, double length, double width) {
  if (std::fabs(u) - length > std::fabs(v) - width) return {std::fabs(u) - length, sign_of(u), 0, -1, 0};
  return {std::fabs(v) - width, 0, sign_of(v), 0, -1};
}

OutlineDistance rounded(double u, double v, double length, double width) {
  const double beyond = std::fabs(u) - (length - width);  // the centre of the end
  if (beyond <= 0) return {std::fabs(v) - width, 0, sign_of(v), 0, -1};
  const double r = std::sqrt(beyond * beyond + v * v);
  if (!(r > 0)) return {-width, sign_of(u), 0, -1, 0};
  return {r - width, sign_of(u) * beyond / r, v / r, -beyond / r, beyond / r - 1};
}

/// The foot of the point on the ellipse is found in the first quadrant by replacing the ellipse by its
/// circle of curvature at the last foot (c, s): a step toward the point on that circle.
OutlineDistance elliptic(double u, double v, double a, double b) {
  const double pu = std::fabs(u), pv = std::fabs(v);
  double c = pu / a + 1e-9, s = pv / b + 1e-9;
  for (int round = 0; round < 40; ++round) {
    const double length = std::sqrt(c * c + s * s);
    c /= length, s /= length;
    const double eu = (a * a - b * b) * c * c * c / a, ev = (b * b - a * a) * s * s * s / b;
    const double ru = a * c - eu, rv = b * s - ev, qu = pu - eu, qv = pv - ev;
    const double r = std::sqrt(ru * ru + rv * rv), q = std::sqrt(qu * qu + qv * qv);
    if (!(q > 0)) break;
    const double next_c = std::clamp((qu * r / q + eu) / a, 0.0, 1.0),
                 next_s = std::clamp((qv * r / q + ev) / b, 0.0, 1.0);
    const double change = std::fabs(next_c - c) + std::fabs(next_s - s);
    c = next_c, s = next_s;
    if (change < 1e-15) break;
  }
  const double length = std::sqrt(c * c + s * s);
  c /= length, s /= length;
  const double slope = std::sqrt(c * c / (a * a) + s * s / (b * b));
  const double nu = c / a / slope, nv = s / b / slope;
  return {(pu - a * c) * nu + (pv - b * s) * nv, sign_of(u) * nu, sign_of(v) * nv, -nu * c, -nv * s};
}

/// One lane of one outline.
class OutlineFit {
 public:
  OutlineFit(Shape shape, const PointColumns& columns, int lane, const Element& start) : shape_(shape), e_(start) {
    for (int t = 0; t < columns.points; ++t) points_.push_back(columns.at(t, lane));
    double height = 0;
    for (const Vec3& p : points_) height += dot(p - e_.point, e_.direction) / columns.points;
    e_.point += height * e_.direction;
  }

  /// nullptr, or why there is no fit.
  const char* run(Element& result) {
    for (const Vec3& p : points_)
      if (!std::isfinite(norm(p))) return reason_of("not_finite");
    if (!choose_held()) return "the touches do not determine it";
    double last = INFINITY;
    for (int round = 0; round < kRounds; ++round) {
      double step[5];
      if (!solve(step)) return reason_of("not_converged");
      const double size = move(step);
      if (!(e_.size > 0 && e_.minor_size > 0)) return reason_of("not_converged");
      if (size < 1e-14 * e_.size || (size < 1e-10 * e_.size && size >= last)) return report(result), nullptr;
      last = size;
    }
    return reason_of("not_converged");
  }

 private:
  static constexpr int kRounds = 60;

  OutlineDistance at(const Vec3& p) const {
    const Vec3 w = p - e_.point, across = cross(e_.direction, e_.second);
    return outline_distance(shape_, e_.angle != 0, dot(w, e_.second), dot(w, across), e_.size, e_.minor_size);
  }

  /// Which unknowns the touches leave open: none, the length, or the length and the place along it.
  bool choose_held() {
    double step[5];
    for (held_ = 0; held_ < 3; ++held_)
      if (solve(step)) return true;
    return false;
  }
  bool is_held(int k) const { return (k == 3 && held_ > 0) || (k == 0 && held_ > 1); }

  bool solve(double (&step)[5]) const {
    SymmetricSystem<double, 5> system;
    const Vec3 across = cross(e_.direction, e_.second);
    for (const Vec3& p : points_) {
      const OutlineDistance o = at(p);
      const double u = dot(p - e_.point, e_.second), v = dot(p - e_.point, across);
      const double row[5] = {-o.nu, -o.nv, o.nu * v - o.nv * u, o.length, o.width};
      for (int i = 0; i < 5; ++i) {
        for (int j = 0; j <= i; ++j)
          if (!is_held(i) && !is_held(j)) system.a[i][j] += row[i] * row[j];
        if (!is_held(i)) system.b[i] -= row[i] * o.d;
      }
    }
    for (int k = 0; k < 5; ++k)
      if (is_held(k)) system.a[k][k] = 1;
    return solve_positive_definite(system, step, 1e-10);
  }

  /// Takes the step; how far it moves the outline, mm.
  double move(const double (&step)[5]) {
    const Vec3 across = cross(e_.direction, e_.second);
    e_.point += step[0] * e_.second + step[1] * across;
    e_.second = unit(perpendicular_part(e_.second + step[2] * across, e_.direction));
    e_.size += step[3];
    e_.minor_size += step[4];
    double size = std::fabs(step[2]) * e_.size;
    for (const int k : {0, 1, 3, 4}) size = std::max(size, std::fabs(step[k]));
    return size;
  }

  void report(Element& result) {
    e_.low = INFINITY, e_.high = -INFINITY;
    for (const Vec3& p : points_) {
      const double d = at(p).d;
      e_.low = std::min(e_.low, d), e_.high = std::max(e_.high, d);
    }
    result = e_;
  }

  Shape shape_;
  Element e_;
  int held_ = 0;
  std::vector<Vec3> points_;
};

}  // namespace

OutlineDistance outline_distance(Shape shape, bool flat_ends, double u, double v, double half_length,
                                 double half_width) {
  if (shape == Shape::ellipse) return elliptic(u, v, half_length, half_width);
  return shape == Shape::rectangle || flat_ends ? flat(u, v, half_length, half_width)
                                                : rounded(u, v, half_length, half_width);
}

template <Shape shape>
void fit_outline_lanes(const PointColumns& columns, const Element* start, Element* result, const char** failure) {
  for (int l = 0; l < columns.lanes; ++l) failure[l] = OutlineFit(shape, columns, l, start[l]).run(result[l]);
}

template void fit_outline_lanes<Shape::slot>(const PointColumns&, const Element*, Element*, const char**);
template void fit_outline_lanes<Shape::rectangle>(const PointColumns&, const Element*, Element*, const char**);
template void fit_outline_lanes<Shape::ellipse>(const PointColumns&, const Element*, Element*, const char**);

}  // namespace abbe
