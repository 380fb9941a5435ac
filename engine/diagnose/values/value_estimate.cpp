#include "engine/diagnose/values/value_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "engine/diagnose/values/value_signature.hpp"

namespace abbe::diagnose {

namespace {

constexpr int kNewtonSteps = 4;
constexpr double kWide = 30;       // typical sizes: a prior that does not pull
constexpr double kSettled = 0.05;  // standard uncertainties
constexpr double kMove = 0.1;      // typical sizes, for the derivatives; they are taken on the same machines
constexpr std::size_t kFirst = 8, kMost = 24;  // variants
constexpr double kNearBest = 6;                // nats

struct BesideErrors {
  Sizes sizes;
  NearSizes near;
};

/// Sizes of the columns of a variant that its effect can have, the nearest to `sizes`.
Vector possible_sizes(const Effect& effect, const Variant& variant, Vector sizes) {
  for (std::size_t k = 0; k < variant.columns.size(); ++k) {
    const EffectParameter& p = effect.parameters[variant.columns[k].parameter];
    double& size = sizes(static_cast<Eigen::Index>(k));
    size = std::clamp(size * variant.columns[k].unit, p.low, p.high) / variant.columns[k].unit;
  }
  return sizes;
}

/// Of few machines: what their number leaves open of the correlations is that of machines without the effect.
Matrix covariance_of(const Matrix& machines, const ValueReference& b) {
  const Matrix centred = machines.rowwise() - machines.colwise().mean();
  const Matrix recorded = b.recorded * b.recorded.transpose();
  const Matrix seen = centred.transpose() * centred / double(machines.rows() - 1) + recorded;
  const Vector by =
      (seen.diagonal().array() + kLeastOfValue_um * kLeastOfValue_um).sqrt() / b.covariance.diagonal().array().sqrt();
  const double share = double(machines.rows()) / double(machines.rows() + machines.cols());
  return share * seen + (1 - share) * Matrix(by.asDiagonal() * b.covariance * by.asDiagonal());
}

/// Fewer would make the scatter that a covariance is estimated with, of so many values, look like a mismatch.
int machines_beside(std::size_t values) {
  constexpr std::size_t kLeast = 200, kOfValue = 20, kMostMachines = 2000;
  return static_cast<int>(std::min(kLeast + kOfValue * values, kMostMachines));
}

class ValueEstimator {
 public:
  explicit ValueEstimator(const ValueReference& b)
      : reference_(b),
        machines_(screened_machines(b.machine, b.options.seed, machines_beside(b.values.size()), b.options.threads)),
        without_(simulated_values(b.values, b.programs, b.machine, machines_, b.options)) {}

  /// Nothing where hardly a machine with the effect reaches the values.
  std::optional<BesideErrors> estimate(const Effect&, const Variant&, const Vector& start) const;

 private:
  const ValueReference& reference_;
  VirtualMachines machines_;
  Matrix without_;  ///< machines x values: deviations without an effect
};

std::optional<BesideErrors> ValueEstimator::estimate(const Effect& effect, const Variant& variant,
                                                     const Vector& start) const {
  const ValueReference& b = reference_;
  const auto values_at = [&](const Vector& sizes) {
    return simulated_values(b.values, b.programs, with_effect(b.machine, effect, variant, sizes), machines_, b.options);
  };
  BesideErrors out;
  out.sizes.mean = start;
  for (int step = 0; step < kNewtonSteps; ++step) {
    const Vector at = possible_sizes(effect, variant, out.sizes.mean);
    const Eigen::Index n = without_.cols(), columns = at.size();
    Matrix together(without_.rows(), (columns + 2) * n);  // next to each other: without, with, beside each derivative
    together << without_, values_at(at), Matrix(without_.rows(), columns * n);
    Vector move(columns);
    for (Eigen::Index k = 0; k < columns; ++k) {
      move(k) = move_within_range(effect, variant, at, k);
      together.middleCols((k + 2) * n, n) = values_at(at + move(k) * Vector::Unit(columns, k));
    }
    together = complete_rows(together);
    if (together.rows() < without_.rows() / 4) return std::nullopt;
    const Vector means = together.colwise().mean(), here = means.segment(n, n);
    Matrix slopes(n, columns);
    for (Eigen::Index k = 0; k < columns; ++k) slopes.col(k) = (means.segment((k + 2) * n, n) - here) / move(k);
    const Matrix covariance = covariance_of(together.middleCols(n, n), b);
    const Matrix weighted = Cholesky(covariance).solve(slopes);
    const Matrix information = slopes.transpose() * weighted + Matrix::Identity(columns, columns) / (kWide * kWide);
    const Matrix gain = Cholesky(information).solve(Matrix(weighted.transpose()));
    out.sizes.covariance = gain * covariance * gain.transpose();
    out.near = {slopes, here - means.head(n) - slopes * at, covariance};
    out.sizes.mean = at + gain * (b.deviation - here);
    const Vector change = possible_sizes(effect, variant, out.sizes.mean) - at;
    if ((change.array().abs() < kSettled * out.sizes.covariance.diagonal().array().sqrt()).all()) break;
  }
  return out;
}

/// Among the variants that were not tried, the one to look at next: the best of each of the first explanations, then
/// whatever may still be the likeliest; -1: none.
int next_variant(const ValueSearch& search, const Vector& deviation, const std::set<int>& tried) {
  const Explanations& all = search.explanations();
  const Evidence evidence = search.evidence(deviation);
  std::set<int> seen;
  for (const int b : tried) seen.insert(all.variants[b].explanation);
  const auto log_belief = [&](std::size_t b) {
    const Variant& variant = all.variants[b];
    return std::log(all.list[variant.explanation].prior * variant.weight) + evidence.variant_log_bayes[b];
  };
  int next = -1;
  double best = -std::numeric_limits<double>::infinity(), top = best;
  for (std::size_t b = 0; b < all.variants.size(); ++b) {
    const int of = all.variants[b].explanation;
    top = std::max(top, log_belief(b));
    if (!all.list[of].effect || tried.contains(static_cast<int>(b))) continue;
    if (seen.size() < kFirst && seen.contains(of)) continue;
    if (log_belief(b) > best) best = log_belief(b), next = static_cast<int>(b);
  }
  return seen.size() < kFirst || best > top - kNearBest ? next : -1;
}

}  // namespace

double move_within_range(const Effect& effect, const Variant& variant, const Vector& sizes, Eigen::Index k) {
  const Column& column = variant.columns[static_cast<std::size_t>(k)];
  return (sizes(k) + kMove) * column.unit <= effect.parameters[column.parameter].high ? kMove : -kMove;
}

Sizes sizes_of(const ValueSearch& search, int variant, const Vector& deviation) {
  const Information info = search.information(variant, deviation);
  const Cholesky root(info.g, 1 / (kWide * kWide));
  return {root.solve(info.u), root.inverse()};
}

Machine with_effect(const Machine& machine, const Effect& effect, const Variant& variant, const Vector& sizes) {
  const Vector taken = possible_sizes(effect, variant, sizes);
  std::vector<double> theta = variant.theta;
  for (std::size_t k = 0; k < variant.columns.size(); ++k)
    theta[variant.columns[k].parameter] = taken(static_cast<Eigen::Index>(k)) * variant.columns[k].unit;
  Machine planted = machine;
  planted.effects.push_back(setting_at(effect, theta));
  return planted;
}

std::map<int, Sizes> linearise_likeliest(ValueSearch& search, const ValueReference& reference) {
  const ValueEstimator estimator(reference);
  std::map<int, Sizes> out;
  std::set<int> tried;
  while (tried.size() < kMost) {
    const int b = next_variant(search, reference.deviation, tried);
    if (b < 0) break;
    tried.insert(b);
    const Variant& variant = search.explanations().variants[b];
    const Effect& effect = *search.explanations().list[variant.explanation].effect;
    const auto found = estimator.estimate(effect, variant, sizes_of(search, b, reference.deviation).mean);
    if (!found) continue;
    search.linearise(b, found->near);
    out.emplace(b, found->sizes);
  }
  return out;
}

}  // namespace abbe::diagnose
