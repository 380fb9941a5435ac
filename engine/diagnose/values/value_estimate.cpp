#include "engine/diagnose/values/value_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "engine/diagnose/findings/carried.hpp"

namespace abbe::diagnose {

namespace {

constexpr int kNewtonSteps = 4;    // until sizes settle, and so many again once all machines have told
constexpr double kWide = 30;       // typical sizes: a prior that does not pull
constexpr double kSettled = 0.05;  // standard uncertainties
constexpr double kAdds = 0.02;     // standard deviations: what differs so little among machines adds to their values
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

Vector variances(const Matrix& machines) {
  return (machines.rowwise() - machines.colwise().mean()).colwise().squaredNorm() / double(machines.rows() - 1);
}

/// Correlated as values of machines without the effect are, with the scatter that these have with it.
Matrix rescaled(const Matrix& machines, const ValueCase& c) {
  const Vector variance = variances(machines) + c.recorded.rowwise().squaredNorm();
  const Vector by =
      ((variance.array() + kLeastOfValue_um * kLeastOfValue_um) / c.judges.covariance.diagonal().array()).sqrt();
  return by.asDiagonal() * c.judges.covariance * by.asDiagonal();
}

/// Of few machines: what their number leaves open of the correlations is that of machines without the effect.
Matrix covariance_of(const Matrix& machines, const ValueCase& c) {
  const Matrix centred = machines.rowwise() - machines.colwise().mean();
  const Matrix seen = centred.transpose() * centred / double(machines.rows() - 1) + c.recorded * c.recorded.transpose();
  const double share = double(machines.rows()) / double(machines.rows() + machines.cols());
  return share * seen + (1 - share) * rescaled(machines, c);
}

/// Fewer would make the scatter that a covariance is estimated with, of so many values, look like a mismatch.
int machines_beside(std::size_t values) {
  constexpr std::size_t kLeast = 200, kOfValue = 20, kMostMachines = 2000;
  return static_cast<int>(std::min(kLeast + kOfValue * values, kMostMachines));
}

/// What an effect of some size does to values, as a few machines tell: differences on the same machines need no more.
struct OnFew {
  Matrix um;     ///< machines x values: deviations
  Vector added;  ///< to each value, on average
  Matrix covariance;
  bool adds = false;  ///< the same on all of them: the covariance is that of machines without the effect
};

/// What all machines tell that the few cannot.
struct OnAll {
  Vector added;
  Matrix covariance;
};

/// Slopes that a step of the sizes has shown to be others than they were (Broyden 1965).
void follow(Matrix& slopes, const Vector& step, const Vector& change) {
  if (const double squared = step.squaredNorm(); squared > 0)
    slopes += (change - slopes * step) * step.transpose() / squared;
}

class ValueEstimator {
 public:
  explicit ValueEstimator(const ValueCase& c)
      : case_(c),
        few_(first_of(c.ensemble.machines, kFew)),
        all_(first_of(c.ensemble.machines, machines_beside(c.ensemble.values.size()))),
        once_(one_repeat(c.ensemble.values)),
        without_(simulated_values(once_, *c.programs, *c.machine, few_, *c.options)) {}

  /// Nothing where hardly a machine with the effect reaches the values.
  std::optional<BesideErrors> estimate(const Effect&, const Variant&, const Vector& start) const;

 private:
  static constexpr int kFew = 100;

  Matrix few_with(const Effect&, const Variant&, const Vector& sizes) const;
  std::optional<OnFew> on_few(const Effect&, const Variant&, const Vector& sizes) const;
  /// Derivatives by the sizes: values x columns.
  std::optional<Matrix> slopes_at(const Effect&, const Variant&, const Vector& sizes, const OnFew&) const;
  std::optional<OnAll> on_all(const Effect&, const Variant&, const Vector& sizes) const;

  const ValueCase& case_;
  VirtualMachines few_, all_;
  std::vector<RecordedValue> once_;
  Matrix without_;  ///< of the few: deviations without an effect
};

bool hardly_any(const Matrix& reached, const VirtualMachines& of) { return reached.rows() < of.size() / 4; }

Matrix ValueEstimator::few_with(const Effect& effect, const Variant& variant, const Vector& sizes) const {
  const ValueCase& c = case_;
  return simulated_values(once_, *c.programs, with_effect(*c.machine, effect, variant, sizes), few_, *c.options);
}

std::optional<OnFew> ValueEstimator::on_few(const Effect& effect, const Variant& variant, const Vector& sizes) const {
  const ValueCase& c = case_;
  OnFew out{few_with(effect, variant, sizes), {}, c.judges.covariance};
  const Matrix added = complete(out.um - without_);
  if (hardly_any(added, few_)) return std::nullopt;
  out.added = added.colwise().mean();
  out.adds = (variances(added).array() < kAdds * kAdds * c.judges.covariance.diagonal().array()).all();
  if (!out.adds) out.covariance = rescaled(complete(out.um), c);
  return out;
}

std::optional<Matrix> ValueEstimator::slopes_at(const Effect& effect, const Variant& variant, const Vector& sizes,
                                                const OnFew& few) const {
  Matrix out(few.um.cols(), sizes.size());
  for (Eigen::Index k = 0; k < sizes.size(); ++k) {
    const double move = move_within_range(effect, variant, sizes, k);
    const Matrix moved = complete(few_with(effect, variant, sizes + move * Vector::Unit(sizes.size(), k)) - few.um);
    if (hardly_any(moved, few_)) return std::nullopt;
    out.col(k) = moved.colwise().mean() / move;
  }
  return out;
}

std::optional<OnAll> ValueEstimator::on_all(const Effect& effect, const Variant& variant, const Vector& sizes) const {
  const ValueCase& c = case_;
  const Eigen::Index n = c.ensemble.simulated.cols();
  const Machine planted = with_effect(*c.machine, effect, variant, sizes);
  const Matrix reached =
      complete(side_by_side(c.ensemble.simulated.topRows(all_.size()),
                            simulated_values(c.ensemble.values, *c.programs, planted, all_, *c.options)));
  if (hardly_any(reached, all_)) return std::nullopt;
  const Matrix with = reached.rightCols(n);
  return OnAll{(with - reached.leftCols(n)).colwise().mean(), covariance_of(with, c)};
}

std::optional<BesideErrors> ValueEstimator::estimate(const Effect& effect, const Variant& variant,
                                                     const Vector& start) const {
  const ValueCase& c = case_;
  BesideErrors out;
  out.sizes.mean = start;
  Vector at, added;
  std::optional<Matrix> slopes;
  std::optional<OnAll> all;
  Vector beyond_few = Vector::Zero(c.deviation.size());
  // First to where sizes settle; then once more, with the slopes of that place and what all machines say there.
  bool settled = false, closer = false;
  for (int step = 0;;) {
    const Vector from = at, added_there = added;
    at = possible_sizes(effect, variant, out.sizes.mean);
    const std::optional<OnFew> few = on_few(effect, variant, at);
    if (!few) return std::nullopt;
    added = few->added;
    const bool anew = !slopes || (settled && !closer);
    if (anew)
      slopes = slopes_at(effect, variant, at, *few);
    else
      follow(*slopes, at - from, added - added_there);
    if (!slopes) return std::nullopt;
    if (settled && !closer) {
      closer = true, step = 0;
      if (!few->adds) {
        all = on_all(effect, variant, at);
        if (!all) return std::nullopt;
        beyond_few = all->added - added;
      }
    }
    const Matrix& covariance = all ? all->covariance : few->covariance;
    const Vector here = added + beyond_few;
    const Matrix weighted = Cholesky(covariance).solve(*slopes);
    const Matrix information =
        slopes->transpose() * weighted + Matrix::Identity(at.size(), at.size()) / (kWide * kWide);
    const Matrix gain = Cholesky(information).solve(Matrix(weighted.transpose()));
    out.near = {*slopes, here - *slopes * at, covariance};
    out.sizes = {at + gain * (c.deviation - c.judges.mean - here), gain * covariance * gain.transpose(), !all};
    const Vector change = possible_sizes(effect, variant, out.sizes.mean) - at;
    settled = (change.array().abs() < kSettled * out.sizes.covariance.diagonal().array().sqrt()).all() ||
        ++step >= kNewtonSteps;
    if (settled && (closer || (anew && few->adds))) return out;
  }
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
  return {root.solve(info.u), root.inverse(), false};
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

std::map<int, Sizes> linearise_likeliest(ValueSearch& search, const ValueCase& c) {
  const ValueEstimator estimator(c);
  std::map<int, Sizes> out;
  std::set<int> tried;
  while (tried.size() < kMost) {
    const int b = next_variant(search, c.deviation, tried);
    if (b < 0) break;
    tried.insert(b);
    const Variant& variant = search.explanations().variants[b];
    const Effect& effect = *search.explanations().list[variant.explanation].effect;
    const auto found = estimator.estimate(effect, variant, sizes_of(search, b, c.deviation).mean);
    if (!found) continue;
    search.linearise(b, found->near);
    out.emplace(b, found->sizes);
  }
  return out;
}

}  // namespace abbe::diagnose
