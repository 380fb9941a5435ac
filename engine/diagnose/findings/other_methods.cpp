#include "engine/diagnose/findings/other_methods.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/diagnose/model/log_sums.hpp"
#include "engine/diagnose/model/precision.hpp"
#include "engine/diagnose/model/rotated.hpp"
#include "engine/math/normal.hpp"

namespace abbe::diagnose {

namespace {

/// Forward selection by BIC over single variants, at the baseline of the recording.
std::vector<std::size_t> forward_selection(const Case& c, std::span<const Matrix* const> variants) {
  constexpr int kMost = 3;
  const Eigen::Index rows = c.model.y.size();
  const double log_n = std::log(double(rows));
  std::vector<const Matrix*> taken;
  std::vector<std::size_t> out;
  while (out.size() < kMost) {
    const Precision precision(with_free(c.model, taken), c.hyper);
    const Precision::Seen y = precision.y();
    double most = 0;
    std::optional<std::size_t> chosen;
    for (std::size_t begin = 0, end = 0; begin < variants.size(); begin = end) {
      end += portion(variants.subspan(begin));
      const Precision::Seen seen = precision.seen(side_by_side(rows, variants.subspan(begin, end - begin)));
      Eigen::Index first = 0;
      for (std::size_t k = begin; k < end; ++k) {
        const Eigen::Index count = variants[k]->cols();
        const Precision::Seen h{seen.rows.middleCols(first, count), seen.taken.middleCols(first, count)};
        first += count;
        const double gain = explained(inner(h, h), inner(h, y))(0) - log_n * double(count);
        if (gain > most) most = gain, chosen = k;
      }
    }
    if (!chosen) break;
    taken.push_back(variants[*chosen]);
    out.push_back(*chosen);
  }
  return out;
}

}  // namespace

OtherMethods other_methods(const Case& c, const Evidence& evidence) {
  OtherMethods out;
  // The paper's model as it stands: specification and nothing re-estimated, chi-squared of what it leaves.
  Hyperparameters stated;
  stated.noise = Vector::Ones(c.baseline.model.noise_groups);
  const Rotated rotated(c.baseline.model, stated);
  out.chi2_p = chi2_above(rotated.squares(), rotated.dof());
  // One best Bayes factor over the catalogue, nothing else allowed.
  std::vector<double> logs;
  std::vector<int> effects;
  for (std::size_t k = 0; k < c.explanations.list.size(); ++k)
    if (c.explanations.list[k].effect) effects.push_back(static_cast<int>(k)), logs.push_back(evidence.log_bayes[k]);
  const auto best = static_cast<std::size_t>(std::max_element(logs.begin(), logs.end()) - logs.begin());
  out.best_bayes_factor = c.explanations.list[effects[best]].name;
  out.best_bayes_probability = std::exp(logs[best] - log_sum_exp(logs));
  std::vector<const Matrix*> signatures;
  std::vector<std::string> names;
  for (const int k : effects)
    for (const int variant : c.explanations.list[k].variants) {
      signatures.push_back(&c.explanations.variants[variant].signature);
      names.push_back(c.explanations.list[k].name);
    }
  for (const std::size_t chosen : forward_selection(c, signatures)) out.stepwise_bic.push_back(names[chosen]);
  return out;
}

}  // namespace abbe::diagnose
