// The lane kernel: the error functions of three axes and their levers, for many touches at once.
//
// Work goes axis by axis, one harmonic at a time: cos and sin of n pi u follow from those of (n-1)
// pi u by angle addition, and each pair serves the six functions of the axis. Tiles keep the
// intermediate columns in the first-level cache; a touch is computed alone whatever tile it is in,
// so tiles do not show in the results.
#include <algorithm>

#include "engine/lanes/elementary.hpp"
#include "engine/lanes/for_lanes.hpp"
#include "engine/machine/geometry.hpp"

namespace abbe {

namespace {

constexpr int kTile = 128;
constexpr int kPerAxis = 6;

struct Tile {
  double error[kPerAxis][kTile];
  double cos_1[kTile], sin_1[kTile], cos_n[kTile], sin_n[kTile];
};

/// One row of the coefficient table for one basis function: [component of the axis][lane].
struct Rows {
  const double* first;
  int lanes;
  double operator()(int component, int lane) const { return first[component * lanes + lane]; }
};

template <class Index>
void start(int n, Index lane, Rows constant, Rows linear, Rows quadratic, const double* enc, double u_per_mm, Tile* t) {
  for_lanes(n, [=](int i) {
    const double u = u_per_mm * enc[i] - 1, q = 2 * u * u - 1;
    const SinCos f = sin_cos_pi(u);
    t->cos_1[i] = t->cos_n[i] = f.cos;
    t->sin_1[i] = t->sin_n[i] = f.sin;
    const int j = lane(i);
    for (int k = 0; k < kPerAxis; ++k) t->error[k][i] = constant(k, j) + linear(k, j) * u + quadratic(k, j) * q;
  });
}

template <class Index>
void add_harmonic(int n, Index lane, Rows cosine, Rows sine, Tile* t) {
  for_lanes(n, [=](int i) {
    const double c = t->cos_n[i], s = t->sin_n[i], c1 = t->cos_1[i], s1 = t->sin_1[i];
    const int j = lane(i);
    for (int k = 0; k < kPerAxis; ++k) t->error[k][i] += cosine(k, j) * c + sine(k, j) * s;
    t->cos_n[i] = c * c1 - s * s1;
    t->sin_n[i] = s * c1 + c * s1;
  });
}

void add_axis(int n, const AxisLever& l, const double* const enc[3], const double* const tip[3], const Tile* t,
              double* const d[3]) {
  const double *ex = enc[0], *ey = enc[1], *ez = enc[2], *tx = tip[0], *ty = tip[1], *tz = tip[2];
  double *dx = d[0], *dy = d[1], *dz = d[2];
  for_lanes(n, [=](int i) {
    const double lx = l.offset_mm.x + l.reach.x * ex[i] + tx[i];
    const double ly = l.offset_mm.y + l.reach.y * ey[i] + ty[i];
    const double lz = l.offset_mm.z + l.reach.z * ez[i] + tz[i];
    const double a = t->error[3][i], b = t->error[4][i], c = t->error[5][i];
    dx[i] += l.sign * (t->error[0][i] + b * lz - c * ly);
    dy[i] += l.sign * (t->error[1][i] + c * lx - a * lz);
    dz[i] += l.sign * (t->error[2][i] + a * ly - b * lx);
  });
}

}  // namespace

GeometryBlock::GeometryBlock(const Machine& machine, std::span<const GeometryCoefficients* const> machines)
    : harmonics_(machine.harmonics), lanes_(static_cast<int>(machines.size())) {
  for (const Axis axis : {Axis::x, Axis::y, Axis::z})
    axes_[static_cast<int>(axis)] = {axis_lever(machine, axis), 2 * machine[axis].direction / machine[axis].travel_mm};
  const int size = basis_size(harmonics_);
  coefficients_.resize(static_cast<std::size_t>(kComponents) * size * lanes_);
  double* out = coefficients_.data();
  for (int axis = 0; axis < 3; ++axis)
    for (int b = 0; b < size; ++b)
      for (int k = 0; k < kPerAxis; ++k)
        for (const GeometryCoefficients* one : machines) *out++ = (*one)[(kPerAxis * axis + k) * size + b];
}

template <class Index>
void GeometryBlock::add_error_indexed(int n, Index lane, const double* const enc[3], const double* const tip[3],
                                      double* const d[3]) const {
  Tile tile;
  for (int axis = 0; axis < 3; ++axis) {
    const auto rows = [&](int b) {
      return Rows{
          coefficients_.data() + (static_cast<std::size_t>(axis) * basis_size(harmonics_) + b) * kPerAxis * lanes_,
          lanes_};
    };
    start(n, lane, rows(0), rows(1), rows(2), enc[axis], axes_[axis].u_per_mm, &tile);
    for (int k = 1; k <= harmonics_; ++k) add_harmonic(n, lane, rows(1 + 2 * k), rows(2 + 2 * k), &tile);
    add_axis(n, axes_[axis].lever, enc, tip, &tile, d);
  }
}

void GeometryBlock::add_error(int n, const int* lane, const double* const enc[3], const double* const tip[3],
                              double* const d[3]) const {
  bool contiguous = true;
  for (int i = 0; i < n; ++i) contiguous &= lane[i] == i;
  for (int from = 0; from < n; from += kTile) {
    const int count = std::min(kTile, n - from);
    const double* const e[3] = {enc[0] + from, enc[1] + from, enc[2] + from};
    const double* const t[3] = {tip[0] + from, tip[1] + from, tip[2] + from};
    double* const out[3] = {d[0] + from, d[1] + from, d[2] + from};
    if (contiguous)
      add_error_indexed(
          count, [from](int i) { return from + i; }, e, t, out);
    else
      add_error_indexed(
          count, [l = lane + from](int i) { return l[i]; }, e, t, out);
  }
}

}  // namespace abbe
