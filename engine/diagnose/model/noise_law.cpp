#include "engine/diagnose/model/noise_law.hpp"

#include <algorithm>
#include <cmath>

#include "engine/diagnose/model/log_sums.hpp"
#include "engine/lanes/distribution.hpp"
#include "engine/lanes/random.hpp"

namespace abbe::diagnose {

namespace {

/// Belief before the data in a normal law; the others share the rest.
constexpr double kPriorNormal = 0.5;
constexpr double kDegrees[] = {3, 4, 5, 7, 10, 15, 25};

/// Log likelihood at the best scale, found by expectation and maximisation, which converges from anywhere.
/// [Lange, Little & Taylor, J. Am. Stat. Ass. 84 (1989) 881]
double student_log_likelihood(const Vector& r, double dof) {
  constexpr int kIterations = 30;
  const auto n = double(r.size());
  const Eigen::ArrayXd squares = r.array().square();
  double scale2 = squares.mean();
  for (int k = 0; k < kIterations; ++k) scale2 = ((dof + 1) * squares / (dof + squares / scale2)).mean();
  return n * (std::lgamma((dof + 1) / 2) - std::lgamma(dof / 2) - 0.5 * std::log(kPi * dof * scale2)) -
      (dof + 1) / 2 * (1 + squares / (dof * scale2)).log().sum();
}

double normal_log_likelihood(const Vector& r) {
  return -0.5 * double(r.size()) * (std::log(2 * kPi * r.array().square().mean()) + 1);
}

UniformPair pair_of(std::uint64_t seed, std::uint32_t stream, int replicate, Eigen::Index i) {
  return uniform_pair({seed, static_cast<std::uint32_t>(replicate), stream, static_cast<std::uint32_t>(i), 0, 0});
}

}  // namespace

NoiseLaw::NoiseLaw(const Vector& standardised) {
  if (standardised.squaredNorm() == 0) return;
  const double share = (1 - kPriorNormal) / double(std::size(kDegrees));
  std::vector<double> logs{std::log(kPriorNormal) + normal_log_likelihood(standardised)};
  for (const double dof : kDegrees) logs.push_back(std::log(share) + student_log_likelihood(standardised, dof));
  const double total = log_sum_exp(logs);
  normal_ = std::exp(logs[0] - total);
  for (std::size_t k = 0; k < std::size(kDegrees); ++k)
    student_.emplace_back(kDegrees[k], std::exp(logs[k + 1] - total));
}

NoiseLaw NoiseLaw::student_t(double dof) {
  NoiseLaw law;
  law.normal_ = 0;
  law.student_ = {{dof, 1}};
  return law;
}

Vector NoiseLaw::simulated(Eigen::Index count, std::uint64_t seed, std::uint32_t stream, int replicate) const {
  double left = pair_of(seed, stream, replicate, count).a - normal_;
  for (const auto& [dof, belief] : student_) {
    if (left < 0) break;
    left -= belief;
    if (left >= 0) continue;
    const Deviation t{Distribution::student_t, std::sqrt((dof - 2) / dof), dof};
    Vector v(count);
    for (Eigen::Index i = 0; i < count; ++i)
      v(i) = std::clamp(deviation(t, pair_of(seed, stream, replicate, i)), -kOutlier, kOutlier);
    return v;
  }
  return standard_normal(count, seed, stream, replicate);
}

double poisson_tail(double count, double expected) {
  constexpr double kNegligible = 1e-17;
  double sum = 0;
  if (count <= expected) {
    double term = std::exp(-expected);
    for (double k = 0; k < count; term *= expected / ++k) sum += term;
    return 1 - sum;
  }
  double term = std::exp(count * std::log(expected) - expected - std::lgamma(count + 1));
  for (double k = count; term > kNegligible * sum; term *= expected / ++k) sum += term;
  return sum;
}

Vector standard_normal(Eigen::Index count, std::uint64_t seed, std::uint32_t stream, int replicate) {
  Vector v(count);
  for (Eigen::Index i = 0; i < count; i += 2) {
    const UniformPair p = pair_of(seed, stream, replicate, i);
    v(i) = normal_quantile(p.a);
    if (i + 1 < count) v(i + 1) = normal_quantile(p.b);
  }
  return v;
}

}  // namespace abbe::diagnose
