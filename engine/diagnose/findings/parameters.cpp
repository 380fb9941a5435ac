// Sizes of what was named, with uncertainties: a mixture over the variants of the effect, each a linear-Gaussian posterior with a prior so
// wide that it does not pull.
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "engine/diagnose/case.hpp"

namespace abbe::diagnose {

namespace {

constexpr double kWide = 30;     // prior standard deviations

/// One variant's estimate of one figure.
struct MixtureTerm {
  double weight = 0, value = 0, u = 0;
};

double normal_below(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

/// The quantile of a mixture of normals, by bisection.
double quantile(const std::vector<MixtureTerm>& mixture, double p) {
  double low = 1e300, high = -1e300;
  for (const MixtureTerm& c : mixture) low = std::min(low, c.value - 10 * c.u - 1e-12), high = std::max(high, c.value + 10 * c.u + 1e-12);
  for (int step = 0; step < 80; ++step) {
    const double x = (low + high) / 2;
    double below = 0;
    for (const MixtureTerm& c : mixture) below += c.weight * (c.u > 0 ? normal_below((x - c.value) / c.u) : (x >= c.value ? 1 : 0));
    (below < p ? low : high) = x;
  }
  return (low + high) / 2;
}

DiagnosedParameter summary(const EffectParameter& parameter, const std::vector<MixtureTerm>& mixture) {
  DiagnosedParameter out{.name = std::string(parameter.name), .unit = std::string(parameter.unit)};
  double square = 0;
  for (const MixtureTerm& c : mixture) out.value += c.weight * c.value;
  for (const MixtureTerm& c : mixture) square += c.weight * (c.u * c.u + std::pow(c.value - out.value, 2));
  out.u = std::sqrt(square);
  out.low = quantile(mixture, 0.025);
  out.high = quantile(mixture, 0.975);
  out.plausible = out.value >= parameter.low && out.value <= parameter.high;
  return out;
}

/// Estimate of a linear parameter in one variant: its coefficient, or the length of the vector along several directions and phases.
MixtureTerm linear_estimate(const Block& block, const Vector& mean, const Matrix& covariance, int parameter) {
  std::vector<Eigen::Index> mine;
  for (std::size_t k = 0; k < block.columns.size(); ++k)
    if (block.columns[k].parameter == parameter) mine.push_back(static_cast<Eigen::Index>(k));
  MixtureTerm out;
  if (mine.empty()) return out;
  const double unit = block.columns[mine.front()].unit;
  if (mine.size() == 1) return {0, unit * mean(mine[0]), unit * std::sqrt(covariance(mine[0], mine[0]))};
  const Vector v = mean(mine);
  const Matrix s = covariance(mine, mine);
  const double length = v.norm();
  const Vector along = length > 0 ? Vector(v / length) : Vector::Unit(v.size(), 0);
  // The length of an uncertain vector is biased upwards by what scatters across it.
  const double variance = along.dot(s * along), across = s.trace() - variance;
  const double corrected = std::sqrt(std::max(0.0, length * length - across));
  return {0, unit * corrected, unit * std::sqrt(variance)};
}

/// The standard deviation of draws: what their likelihood says of it, beside what the machine file lets them do anyway.
std::vector<MixtureTerm> spread_estimate(const EvidenceSearch::Information& info, double unit) {
  constexpr double kLeast = 0.01, kMost = 100, kStep = 1.03;
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(info.g);
  const Vector d = solver.eigenvalues().cwiseMax(0), t = (solver.eigenvectors().transpose() * info.u).array().square();
  std::vector<MixtureTerm> terms;
  std::vector<double> logs;
  for (double s = kLeast; s < kMost; s *= kStep) {
    const Vector v = 1 + s * s * d.array();
    logs.push_back(0.5 * (s * s * (t.array() / v.array()).sum() - v.array().log().sum()) + std::log(s));   // evenly in s
    terms.push_back({0, unit * s, unit * s * (kStep - 1) / std::sqrt(12.0)});
  }
  const double total = log_sum_exp(logs);
  for (std::size_t k = 0; k < terms.size(); ++k) terms[k].weight = std::exp(logs[k] - total);
  return terms;
}

class Estimator {
 public:
  Estimator(const Case& c, const SearchResult& result, std::size_t which) : explanation_(c.explanations.list[result.findings[which].explanation]) {
    std::vector<const Matrix*> others;
    for (std::size_t k = 0; k < result.findings.size(); ++k)
      if (k != which) others.push_back(&c.explanations.blocks[result.findings[k].block].signature);
    const Explanations mine = only(c.explanations, {result.findings[which].explanation});
    // Scale and noise as they are once everything named is taken out.
    std::vector<const Matrix*> all = others;
    all.push_back(&c.explanations.blocks[result.findings[which].block].signature);
    const Hyperparameters hyper = estimate(with_free(c.model, all));
    const EvidenceSearch search(with_free(c.model, others), hyper, mine);
    const Evidence evidence = search.evidence();
    // A size in all runs and a change from one run to the next are two figures: that of the likeliest variant is told.
    const int from_run = c.explanations.blocks[result.findings[which].block].from_run;
    std::vector<double> logs;
    for (const Block& b : mine.blocks)
      logs.push_back(b.from_run == from_run ? evidence.block_log_bayes[logs.size()] + std::log(b.weight) : -std::numeric_limits<double>::infinity());
    const double total = log_sum_exp(logs);
    for (std::size_t b = 0; b < mine.blocks.size(); ++b) {
      const double weight = std::exp(logs[b] - total);
      if (weight < 1e-4) continue;
      const auto info = search.information(static_cast<int>(b));
      const Matrix precision = info.g + Matrix::Identity(info.g.rows(), info.g.cols()) / (kWide * kWide);
      const Eigen::LLT<Matrix> llt(precision);
      variants_.push_back({weight, mine.blocks[b], llt.solve(info.u), llt.solve(Matrix::Identity(info.g.rows(), info.g.cols())), info});
    }
  }

  std::vector<DiagnosedParameter> all() const {
    std::vector<DiagnosedParameter> out;
    const Effect& effect = *explanation_.effect;
    for (std::size_t p = 0; p < effect.parameters.size(); ++p) {
      const EffectParameter& parameter = effect.parameters[p];
      if (parameter.linear) {
        const auto mixture = effect.draws > 0 ? spread(parameter) : linear(static_cast<int>(p));
        if (!mixture.empty()) out.push_back(summary(parameter, mixture));
      } else if (!parameter.choices.empty()) {
        if (const auto word = chosen(p)) out.push_back({.name = std::string(parameter.name), .unit = "", .word = *word});
      } else if (varies(p)) {
        out.push_back(summary(parameter, searched(p)));
      }
    }
    return out;
  }

 private:
  struct Variant {
    double weight;
    Block block;
    Vector mean;
    Matrix covariance;
    EvidenceSearch::Information info;
  };

  std::vector<MixtureTerm> linear(int p) const {
    std::vector<MixtureTerm> mixture;
    double total = 0;
    for (const Variant& v : variants_) {
      MixtureTerm c = linear_estimate(v.block, v.mean, v.covariance, p);
      if (c.u == 0) continue;
      c.weight = v.weight;
      total += v.weight;
      mixture.push_back(c);
    }
    for (MixtureTerm& c : mixture) c.weight /= total;
    return mixture;
  }

  std::vector<MixtureTerm> spread(const EffectParameter& parameter) const {
    std::vector<MixtureTerm> mixture;
    for (const Variant& v : variants_) {
      for (MixtureTerm c : spread_estimate(v.info, parameter.typical)) {
        c.weight *= v.weight;
        mixture.push_back(c);
      }
    }
    return normalised(mixture);
  }

  std::vector<MixtureTerm> searched(std::size_t p) const {
    std::vector<MixtureTerm> mixture;
    for (const Variant& v : variants_) mixture.push_back({v.weight, v.block.theta[p], (v.block.cells[p].high - v.block.cells[p].low) / std::sqrt(12.0)});
    return normalised(mixture);
  }

  static std::vector<MixtureTerm> normalised(std::vector<MixtureTerm> mixture) {
    double total = 0;
    for (const MixtureTerm& c : mixture) total += c.weight;
    for (MixtureTerm& c : mixture) c.weight /= total;
    return mixture;
  }

  bool varies(std::size_t p) const {
    return std::any_of(variants_.begin(), variants_.end(), [&](const Variant& v) { return v.block.theta[p] != variants_.front().block.theta[p]; }) ||
           explanation_.effect->parameters[p].name == "t0_s" || explanation_.effect->parameters[p].name == "period_s";
  }

  /// The word of a choice: the likeliest one, or of a spanned direction the axis that dominates.
  std::optional<std::string> chosen(std::size_t p) const {
    const EffectParameter& parameter = explanation_.effect->parameters[p];
    const auto best = std::max_element(variants_.begin(), variants_.end(), [](const Variant& a, const Variant& b) { return a.weight < b.weight; });
    const bool spanned = std::any_of(best->block.columns.begin(), best->block.columns.end(), [](const Column& c) { return c.part % 3 != 0; });
    if (!spanned || parameter.name != "direction") {
      const auto code = static_cast<std::size_t>(best->block.theta[p] - parameter.low + 0.5);
      return code < parameter.choices.size() ? std::optional(std::string(parameter.choices[code])) : std::nullopt;
    }
    double energy[3] = {};
    for (std::size_t k = 0; k < best->block.columns.size(); ++k) energy[best->block.columns[k].part % 3] += std::pow(best->mean(static_cast<Eigen::Index>(k)), 2);
    const double all = energy[0] + energy[1] + energy[2];
    for (int k = 0; k < 3; ++k)
      if (energy[k] > 0.9 * all) return std::string(parameter.choices[static_cast<std::size_t>(k)]);
    return std::string(parameter.choices[3]);
  }

  const Explanation& explanation_;
  std::vector<Variant> variants_;
};

}  // namespace

std::vector<DiagnosedParameter> estimate_parameters(const Case& c, const SearchResult& result, std::size_t finding) {
  return Estimator(c, result, finding).all();
}

}  // namespace abbe::diagnose
