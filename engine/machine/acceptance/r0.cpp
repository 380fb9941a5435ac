// R0: every length of E0 is measured three times, and the range of the three may not exceed R0,MPL.
//
// A length is the difference of two touches along the line, so by the probe alone its standard
// deviation is
//   s = sqrt(2 u' S u),   u the direction of the line, S the covariance of a touch.
// The range of three normal values over s has a known distribution W, and all 35 lengths are
// independent. So the share of tests that pass is the product of W(limit / s) over the 35 lengths:
// no simulation. The median is that of the largest range.
#include <algorithm>
#include <cmath>

#include "engine/machine/acceptance/acceptance.hpp"
#include "engine/machine/head.hpp"
#include "engine/math/normal.hpp"

namespace abbe {
namespace {

double normal_pdf(double x) { return std::exp(-0.5 * x * x) / std::sqrt(2 * kPi); }

/// P(no range of the test exceeds limit).
double share_within(const std::vector<double>& sd_mm, double limit_mm) {
  double share = 1;
  for (const double sd : sd_mm) share *= sd > 0 ? range_of_three_cdf(limit_mm / sd) : 1;
  return share;
}

double median_of(const std::vector<double>& sd_mm) {
  double low = 0, high = 0;
  for (const double sd : sd_mm) high = std::max(high, 20 * sd);
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (share_within(sd_mm, middle) < 0.5 ? low : high) = middle;
  }
  return high;
}

std::vector<ProbeCheck> check_r0(const Machine& machine, std::uint64_t) {
  const std::optional<double> limit = machine.specification.r0_mpl_mm;
  if (!limit) return {};
  const Mat3 R_WR = head_rotation(0, machine.head.mounting_rad);
  std::vector<double> sd_mm;
  for (const TestLine& line : test_lines(machine)) {
    if (line.test != "E0") continue;
    const Vec3 u_R = transpose(R_WR) * line.direction;
    const Vec3 s = machine.probe.sd_mm;
    const double sd = std::sqrt(2.0) * norm(Vec3{u_R.x * s.x, u_R.y * s.y, u_R.z * s.z});
    sd_mm.insert(sd_mm.end(), kLengthsPerLine, sd);
  }
  return {{"R0", *limit, median_of(sd_mm), share_within(sd_mm, *limit)}};
}

}  // namespace

double range_of_three_cdf(double r) {
  // 3 int phi(x) (Phi(x + r) - Phi(x))^2 dx, x the smallest of the three. The integrand is smooth
  // and vanishes at both ends, where the trapezoidal rule converges faster than any power of the
  // step.
  constexpr double kEnd = 9, kStep = 1.0 / 16;
  double sum = 0;
  for (double x = -kEnd; x <= kEnd; x += kStep) {
    const double between = normal_below(x + r) - normal_below(x);
    sum += normal_pdf(x) * between * between;
  }
  return r > 0 ? 3 * kStep * sum : 0;
}

extern const AcceptanceTest repeatability_r0_test{
    .name = "R0",
    .help = "range of three repeats of every length of E0, by the repeatability of the probe",
    .source = "ISO 10360-2:2009 (R0)",
    .probe = check_r0,
};

}  // namespace abbe
