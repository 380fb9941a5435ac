// What a recording can tell, from its plan alone: the smallest size of each effect that would be detected, and the smallest that would be
// told from its nearest rival (minimal detectable and minimal identifiable bias: Baarda 1968; Zaminpardaz & Teunissen 2024).
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "engine/diagnose/case.hpp"

namespace abbe::diagnose {

namespace {

/// An effect that would have to move a touch by more than this to be seen does, for these touches, nothing.
constexpr double kNothing_um = 1e4;

int first_linear(const Block& b) { return b.columns.empty() ? -1 : b.columns.front().parameter; }

/// The column of a block that stands for the effect: its strongest one.
Eigen::Index strongest(const Matrix& g) {
  Eigen::Index k = 0;
  g.diagonal().maxCoeff(&k);
  return k;
}

class Design {
 public:
  Design(const Case& c, const EvidenceSearch& search) : all_(c.explanations), search_(search) {
    for (int b = 0; b < static_cast<int>(all_.blocks.size()); ++b) {
      const Matrix g = search.between(b, b);
      information_.emplace_back(g + 1e-9 * (g.trace() + 1e-300) * Matrix::Identity(g.rows(), g.cols()));
      strongest_.push_back(strongest(g));
      most_.push_back(g.diagonal().maxCoeff());
    }
  }

  std::optional<Detectable> of(std::size_t k) const {
    const Explanation& e = all_.list[k];
    if (e.blocks.empty()) return std::nullopt;
    const int best = *std::max_element(e.blocks.begin(), e.blocks.end(), [&](int a, int b) { return most_[a] < most_[b]; });
    const double most = most_[static_cast<std::size_t>(best)];
    if (most <= 1e-12) return std::nullopt;
    const Block& block = all_.blocks[static_cast<std::size_t>(best)];
    const Eigen::Index column = strongest_[static_cast<std::size_t>(best)];
    const int p = block.joined ? first_parameter(*e.effect) : std::max(0, first_linear(block));
    const int parameter = block.joined ? p : block.columns[static_cast<std::size_t>(column)].parameter;
    const double unit = block.joined ? e.effect->parameters[static_cast<std::size_t>(p)].typical : block.columns[static_cast<std::size_t>(column)].unit;
    const double largest = block.signature.col(column).cwiseAbs().maxCoeff();
    Detectable d{.effect = e.name, .parameter = std::string(e.effect->parameters[static_cast<std::size_t>(parameter)].name),
                 .unit = std::string(e.effect->parameters[static_cast<std::size_t>(parameter)].unit), .name = {}, .name_um = {}, .confounded_with = {}};
    d.detect = unit * kDetects / std::sqrt(most);
    d.detect_um = largest * kDetects / std::sqrt(most);
    if (d.detect_um > kNothing_um) return std::nullopt;
    add_rivals(k, best, column, most, unit, largest, d);
    return d;
  }

 private:
  static int first_parameter(const Effect& effect) {
    for (std::size_t p = 0; p < effect.parameters.size(); ++p)
      if (effect.parameters[p].linear) return static_cast<int>(p);
    return 0;
  }

  void add_rivals(std::size_t k, int block, Eigen::Index column, double information, double unit, double largest, Detectable& d) const {
    // What is left of the information on the column once a rival takes what it can.
    const Vector cross = search_.against_all(block, column);
    const auto left = [&](int rival) {
      const Vector with = cross.segment(search_.first_column(rival), all_.blocks[static_cast<std::size_t>(rival)].signature.cols());
      return information - with.dot(information_[static_cast<std::size_t>(rival)].solve(with));
    };
    std::vector<std::pair<double, std::string>> shares;
    for (std::size_t j = 0; j < all_.list.size(); ++j) {
      if (j == k || !all_.list[j].effect) continue;
      double least = 1;
      for (const int b : all_.list[j].blocks) least = std::min(least, left(b) / information);
      shares.emplace_back(std::max(0.0, least), all_.list[j].name);
    }
    std::stable_sort(shares.begin(), shares.end());
    for (const auto& [share, name] : shares)
      if (share < 1 - kConfounded * kConfounded && d.confounded_with.size() < 4) d.confounded_with.push_back(name);
    const double share = shares.empty() ? 1 : shares.front().first;
    if (share < kInseparable) return;
    d.name = unit * kNames / std::sqrt(information * share);
    d.name_um = largest * kNames / std::sqrt(information * share);
  }

  const Explanations& all_;
  const EvidenceSearch& search_;
  std::vector<Eigen::LDLT<Matrix>> information_;   ///< by block
  std::vector<Eigen::Index> strongest_;            ///< by block: the column that stands for it
  std::vector<double> most_;                       ///< by block: the information on that column
};

/// The probability that chi-squared of n degrees of freedom exceeds x (Wilson & Hilferty 1931).
double chi2_above(double x, double n) {
  const double z = (std::cbrt(x / n) - (1 - 2 / (9 * n))) / std::sqrt(2 / (9 * n));
  return 0.5 * std::erfc(z / std::sqrt(2.0));
}

}  // namespace

std::vector<Detectable> smallest_detectable(const Case& c, const EvidenceSearch& search) {
  const Design design(c, search);
  std::vector<Detectable> out;
  for (std::size_t k = 0; k < c.explanations.list.size(); ++k) {
    if (!c.explanations.list[k].effect || c.explanations.list[k].missing) continue;
    if (auto d = design.of(k)) out.push_back(std::move(*d));
  }
  return out;
}

Rivals rivals(const Case& c, const Evidence& evidence) {
  Rivals out;
  // The paper's model as it stands: specification and nothing re-estimated, chi-squared of what it leaves.
  Hyperparameters stated;
  stated.noise = Vector::Ones(c.baseline.model.noise_groups);
  const Rotated rotated(c.baseline.model, stated);
  const Vector z = rotated.z();
  const double rest = rotated.remainder(rotated.y(), z).squaredNorm();
  const double squares = (z.array().square() / (1 + rotated.lambda().array())).sum() + rest;
  out.chi2_p = chi2_above(squares, rotated.rank() + rotated.rest_dof());
  // One best Bayes factor over the catalogue, nothing else allowed.
  std::vector<double> logs;
  std::vector<int> effects;
  for (std::size_t k = 0; k < c.explanations.list.size(); ++k)
    if (c.explanations.list[k].effect) effects.push_back(static_cast<int>(k)), logs.push_back(evidence.log_bayes[k]);
  const auto best = static_cast<std::size_t>(std::max_element(logs.begin(), logs.end()) - logs.begin());
  out.best_bayes_factor = c.explanations.list[static_cast<std::size_t>(effects[best])].name;
  out.best_bayes_probability = std::exp(logs[best] - log_sum_exp(logs));
  // Forward selection by BIC over single variants.
  const Explanations catalogue = only(c.explanations, effects);
  std::vector<const Matrix*> taken;
  const double log_n = std::log(double(c.model.y.size()));
  for (int step = 0; step < 3; ++step) {
    const EvidenceSearch now(with_free(c.model, taken), c.hyper, catalogue);
    double most = 0;
    int chosen = -1;
    for (std::size_t b = 0; b < catalogue.blocks.size(); ++b) {
      const auto info = now.information(static_cast<int>(b));
      const Matrix g = info.g + 1e-9 * (1 + info.g.trace()) * Matrix::Identity(info.g.rows(), info.g.cols());
      const double gain = info.u.dot(Eigen::LDLT<Matrix>(g).solve(info.u)) - log_n * double(info.u.size());
      if (gain > most) most = gain, chosen = static_cast<int>(b);
    }
    if (chosen < 0) break;
    const Block& block = catalogue.blocks[static_cast<std::size_t>(chosen)];
    taken.push_back(&block.signature);
    out.stepwise_bic.push_back(catalogue.list[static_cast<std::size_t>(block.explanation)].name);
  }
  return out;
}

}  // namespace abbe::diagnose
