// Form and size by one stylus: 25 touches on a sphere. Form is the range of the 25 distances from
// the centre of the least-squares sphere, size the error of its diameter.
//
// The touches carry the probe's noise alone: over a sphere of some 30 mm the geometric errors hardly
// change. With errors of a few um on such a sphere the fit is linear: touch i with unit normal n_i
// and radial error e_i gives, in the least-squares sense,
//   e_i = n_i . c + r + residual_i,   c error of the centre, r of the radius,
// so neither form nor size depends on the size of the sphere.
#include <algorithm>
#include <cmath>

#include "engine/base/ids.hpp"
#include "engine/lanes/random.hpp"
#include "engine/machine/acceptance/acceptance.hpp"
#include "engine/machine/head.hpp"
#include "engine/math/cholesky.hpp"

namespace abbe {
namespace {

constexpr int kTouches = 25, kUnknowns = 4;
constexpr int kTests = 10'000;  ///< the share passed is known to 0.5 % (one standard deviation) or better

double unknown_of(const Vec3& n, int j) { return j < 3 ? n[j] : 1; }

/// gain[i]: what a unit error of touch i does to the centre (x, y, z) and the radius.
std::array<std::array<double, kUnknowns>, kTouches> fit_gain(const std::array<Vec3, kTouches>& normal) {
  SymmetricSystem<double, kUnknowns> system;
  for (const Vec3& n : normal)
    for (int j = 0; j < kUnknowns; ++j)
      for (int k = 0; k <= j; ++k) system.a[j][k] += unknown_of(n, j) * unknown_of(n, k);
  std::array<std::array<double, kUnknowns>, kTouches> gain;
  for (int i = 0; i < kTouches; ++i) {
    double x[kUnknowns];
    for (int j = 0; j < kUnknowns; ++j) system.b[j] = unknown_of(normal[i], j);
    ABBE_CHECK(solve_positive_definite(system, x, 1e-9));
    std::copy(x, x + kUnknowns, gain[i].begin());
  }
  return gain;
}

/// Radial errors of kTests tests, [touch][test].
std::vector<std::vector<double>> radial_errors(const Machine& machine, const std::array<Vec3, kTouches>& normal,
                                               std::uint64_t seed) {
  const Mat3 R_RW = transpose(head_rotation(0, machine.head.mounting_rad));
  const Vec3 sd = machine.probe.sd_mm;
  std::vector<std::uint32_t> test(kTests), visit(kTests, 0);
  for (int t = 0; t < kTests; ++t) test[t] = static_cast<std::uint32_t>(t);
  std::vector<double> x(kTests), y(kTests), z(kTests), unused(kTests);
  std::vector<std::vector<double>> error(kTouches, std::vector<double>(kTests));
  for (int i = 0; i < kTouches; ++i) {
    constexpr std::uint32_t kStream = stream_of("acceptance.form_and_size");
    const auto site = static_cast<std::uint32_t>(i);
    normal_pairs(kTests, seed, test.data(), kStream, site, visit.data(), 0, x.data(), y.data());
    normal_pairs(kTests, seed, test.data(), kStream, site, visit.data(), 1, z.data(), unused.data());
    const Vec3 n_R = R_RW * normal[i];
    for (int t = 0; t < kTests; ++t) error[i][t] = n_R.x * sd.x * x[t] + n_R.y * sd.y * y[t] + n_R.z * sd.z * z[t];
  }
  return error;
}

ProbeCheck judge(std::string_view name, double limit_mm, std::vector<double> values_mm) {
  std::sort(values_mm.begin(), values_mm.end());
  const auto passed = std::upper_bound(values_mm.begin(), values_mm.end(), limit_mm) - values_mm.begin();
  return {name, limit_mm, values_mm[kTests / 2], double(passed) / kTests};
}

std::vector<ProbeCheck> check_form_and_size(const Machine& machine, std::uint64_t seed) {
  const Specification& spec = machine.specification;
  if (!spec.form_mpe_mm && !spec.size_mpe_mm) return {};
  const auto normal = form_and_size_pattern();
  const auto gain = fit_gain(normal);
  const auto error = radial_errors(machine, normal, seed);
  std::vector<double> form(kTests), size(kTests);
  for (int t = 0; t < kTests; ++t) {
    double x[kUnknowns] = {};
    for (int i = 0; i < kTouches; ++i)
      for (int j = 0; j < kUnknowns; ++j) x[j] += gain[i][j] * error[i][t];
    double low = 0, high = 0;  // the residuals of a least-squares fit with a constant term sum to 0
    for (int i = 0; i < kTouches; ++i) {
      const double residual = error[i][t] - dot(normal[i], {x[0], x[1], x[2]}) - x[3];
      low = std::min(low, residual), high = std::max(high, residual);
    }
    form[t] = high - low;
    size[t] = std::fabs(2 * x[3]);
  }
  std::vector<ProbeCheck> checks;
  if (spec.form_mpe_mm) checks.push_back(judge("P_Form.Sph.1x25", *spec.form_mpe_mm, std::move(form)));
  if (spec.size_mpe_mm) checks.push_back(judge("P_Size.Sph.1x25", *spec.size_mpe_mm, std::move(size)));
  return checks;
}

}  // namespace

std::array<Vec3, 25> form_and_size_pattern() {
  constexpr int counts[] = {1, 4, 8, 4, 8};
  std::array<Vec3, 25> normal;
  int i = 0;
  for (int circle = 0; circle < 5; ++circle)
    for (int k = 0; k < counts[circle]; ++k) {
      const double polar = circle * kPi / 8;
      const double azimuth = 2 * kPi * k / counts[circle] + std::max(0, circle - 1) * kPi / 8;
      normal[i++] = {std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)};
    }
  return normal;
}

extern const AcceptanceTest form_and_size_test{
    .name = "form and size",
    .help =
        "25 touches on a sphere: range of the radial distances and error of the diameter, by the "
        "repeatability of the probe",
    .source = "ISO 10360-5:2020 (P_Form.Sph.1x25, P_Size.Sph.1x25)",
    .probe = check_form_and_size,
};

}  // namespace abbe
