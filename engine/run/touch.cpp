#include "engine/run/touch.hpp"

#include "engine/lanes/for_lanes.hpp"
#include "engine/lanes/random.hpp"

namespace abbe {

void TouchBatch::resize(int size) {
  n = size;
  for (Columns3* c : {&commanded, &normal, &surface, &surface_normal, &reading, &tip, &error}) c->resize(size);
  for (auto* v : {&radius, &travel}) v->resize(size);
  lane.resize(size);
  machine.resize(size);
  visit.resize(size);
}

void add_probe_noise(TouchBatch& batch, const ProbeSpec& probe, std::uint64_t seed, std::uint32_t site,
                     const std::vector<Mat3>& R_WR) {
  constexpr std::uint32_t stream = stream_of("probe");
  const int n = batch.n;
  // Two calls make two pairs of normal numbers per touch; three are used, the fourth keeps its address free.
  std::vector<double> z(4 * static_cast<std::size_t>(n));
  double *x = z.data(), *y = x + n, *w = y + n, *spare = w + n;
  normal_pairs(n, seed, batch.machine.data(), stream, site, batch.visit.data(), 0, x, y);
  normal_pairs(n, seed, batch.machine.data(), stream, site, batch.visit.data(), 1, w, spare);
  for (int i = 0; i < n; ++i) {
    const Vec3 noise_R{probe.sd_mm.x * x[i], probe.sd_mm.y * y[i], probe.sd_mm.z * w[i]};
    batch.error.set(i, batch.error.get(i) + R_WR[i] * noise_R);
  }
}

void find_contact(TouchBatch& batch) {
  const auto columns = [](Columns3& c) {
    return std::array<double*, 3>{c.column[0].data(), c.column[1].data(), c.column[2].data()};
  };
  const auto c = columns(batch.commanded), n = columns(batch.normal), p = columns(batch.surface),
             m = columns(batch.surface_normal), d = columns(batch.error);
  const double* radius = batch.radius.data();
  double* travel = batch.travel.data();
  for_lanes(batch.n, [=](int i) {
    const double ahead = m[0][i] * (c[0][i] - d[0][i] - p[0][i]) + m[1][i] * (c[1][i] - d[1][i] - p[1][i]) +
        m[2][i] * (c[2][i] - d[2][i] - p[2][i]);
    const double cosine = m[0][i] * n[0][i] + m[1][i] * n[1][i] + m[2][i] * n[2][i];
    travel[i] = (radius[i] - ahead) / cosine;
  });
}

}  // namespace abbe
