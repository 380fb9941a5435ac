#include "engine/diagnose/baseline/length_errors.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/diagnose/quantile.hpp"

namespace abbe::diagnose {

namespace {

/// cosine between a normal and the length, at most 0.8 degrees: a length touched across depends on where the
/// part stood
constexpr double kAlong = 0.9999;

bool comparable(const TouchScene& a, const TouchScene& b) {
  return a.setup == b.setup && a.run == b.run && a.stylus.tip_ordinal == b.stylus.tip_ordinal && a.visit == b.visit;
}

double share(const LengthError& e) { return std::abs(e.error_mm) / e.mpe_mm; }

}  // namespace

Vector without_placement(const LinearModel& m) {
  constexpr int kMostSteps = 20;
  constexpr double kGross = 10, kFine_um = 1;
  Vector left = m.y - m.free * least_squares(m.free, m.y);
  for (int step = 0; step < kMostSteps; ++step) {
    const Vector size = left.cwiseAbs();
    if (size.maxCoeff() <= kGross * median({size.begin(), size.end()})) break;
    const Vector weight = size.cwiseMax(kFine_um).cwiseInverse().cwiseSqrt();
    left = m.y - m.free * least_squares(weight.asDiagonal() * m.free, Vector(weight.cwiseProduct(m.y)));
  }
  return left;
}

std::optional<LengthError> worst_length(const RecordedTouches& t, const Vector& residuals_um,
                                        const Specification& specification, const std::vector<char>& left_out) {
  constexpr int kCount = 3;
  constexpr double kLeast_mm = 1;
  LengthError worst;
  // Each touch once: a dirty one is in as many lengths as it has partners.
  std::vector<char> used = left_out;
  used.resize(t.touches.size(), 0);
  for (int k = 0; k < kCount; ++k) {
    worst = {};
    std::size_t from = 0, to = 0;
    for (std::size_t i = 0; i < t.touches.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const TouchScene &a = t.touches[i].scene, &b = t.touches[j].scene;
        const Vec3 between = a.point - b.point;
        const double length = norm(between);
        if (used[i] || used[j] || length < kLeast_mm || !comparable(a, b)) continue;
        const double along_a = dot(a.normal, between) / length, along_b = dot(b.normal, between) / length;
        if (std::min(std::abs(along_a), std::abs(along_b)) < kAlong) continue;
        const LengthError e{
            length, (along_a * residuals_um(Eigen::Index(i)) - along_b * residuals_um(Eigen::Index(j))) / kUmPerMm,
            specification.mpe.at(length)};
        if (from == to || share(e) > share(worst)) worst = e, from = i, to = j;
      }
    }
    if (from == to) return std::nullopt;
    used[from] = used[to] = 1;
  }
  return worst;
}

std::optional<LengthError> beyond_specification(const std::optional<LengthError>& worst, const Machine& machine) {
  constexpr double kElsewhere = 1.5, kDeviations = 4;
  const double touch_mm = norm(machine.probe.sd_mm) / std::sqrt(3.0);
  if (!worst || std::abs(worst->error_mm) <= kElsewhere * worst->mpe_mm + kDeviations * std::sqrt(2.0) * touch_mm)
    return std::nullopt;
  return worst;
}

void hold_to_specification(LinearModel& m) {
  constexpr double kScaleSpread = 0.1;
  m.scale_spread = kScaleSpread;
  m.uneven.clear();
}

Deviations deviations(const LinearModel& m, double noise_um) {
  const Matrix free = independent(m.free);
  const Matrix random = m.random - free * (free.transpose() * m.random);
  const Vector y = m.y - free * (free.transpose() * m.y);
  const auto left = static_cast<double>(m.y.size() - free.cols());
  return {std::sqrt(std::max(0.0, y.squaredNorm() / left - noise_um * noise_um)),
          std::sqrt(random.squaredNorm() / left)};
}

}  // namespace abbe::diagnose
