#include "engine/lanes/weighted_sum.hpp"

#include "engine/lanes/for_lanes.hpp"

namespace abbe {

void add_weighted(int n, std::span<const WeightedVector> terms, double* x, double* y, double* z) {
  // Four terms for each trip of the sums through memory.
  std::size_t k = 0;
  for (; k + 4 <= terms.size(); k += 4) {
    const Vec3 a = terms[k].vector, b = terms[k + 1].vector, c = terms[k + 2].vector, d = terms[k + 3].vector;
    const double *wa = terms[k].weight, *wb = terms[k + 1].weight, *wc = terms[k + 2].weight, *wd = terms[k + 3].weight;
    for_lanes(n, [=](int i) {
      x[i] = x[i] + a.x * wa[i] + b.x * wb[i] + c.x * wc[i] + d.x * wd[i];
      y[i] = y[i] + a.y * wa[i] + b.y * wb[i] + c.y * wc[i] + d.y * wd[i];
      z[i] = z[i] + a.z * wa[i] + b.z * wb[i] + c.z * wc[i] + d.z * wd[i];
    });
  }
  for (; k < terms.size(); ++k) {
    const Vec3 a = terms[k].vector;
    const double* wa = terms[k].weight;
    for_lanes(n, [=](int i) {
      x[i] += a.x * wa[i];
      y[i] += a.y * wa[i];
      z[i] += a.z * wa[i];
    });
  }
}

}  // namespace abbe
