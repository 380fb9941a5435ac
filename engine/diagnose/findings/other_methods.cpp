#include "engine/diagnose/findings/other_methods.hpp"

#include <algorithm>
#include <cmath>

#include "engine/diagnose/model/log_sums.hpp"
#include "engine/diagnose/model/precision.hpp"
#include "engine/diagnose/model/rotated.hpp"
#include "engine/math/normal.hpp"

namespace abbe::diagnose {

namespace {

/// Forward selection by BIC over single variants, at the baseline of the recording.
std::vector<int> forward_selection(const Case& c, const std::vector<Variant>& variants) {
  constexpr int kMost = 3;
  std::vector<const Matrix*> signatures;
  for (const Variant& v : variants) signatures.push_back(&v.signature);
  const Matrix patterns = side_by_side(c.model.y.size(), signatures);
  const double log_n = std::log(double(c.model.y.size()));
  std::vector<const Matrix*> taken;
  std::vector<int> out;
  while (out.size() < kMost) {
    const Precision precision(with_free(c.model, taken), c.hyper);
    const Precision::Seen y = precision.y(), all = precision.seen(patterns);
    double most = 0;
    int chosen = -1;
    Eigen::Index first = 0;
    for (std::size_t k = 0; k < variants.size(); ++k) {
      const Eigen::Index count = variants[k].signature.cols();
      const Precision::Seen h{all.rows.middleCols(first, count), all.taken.middleCols(first, count)};
      first += count;
      const double gain = explained(inner(h, h), inner(h, y))(0) - log_n * double(count);
      if (gain > most) most = gain, chosen = static_cast<int>(k);
    }
    if (chosen < 0) break;
    taken.push_back(&variants[chosen].signature);
    out.push_back(chosen);
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
  out.best_bayes_factor = c.explanations.list[effects[best]].name;
  out.best_bayes_probability = std::exp(logs[best] - log_sum_exp(logs));
  const Explanations catalogue = only(c.explanations, effects);
  for (const int chosen : forward_selection(c, catalogue.variants))
    out.stepwise_bic.push_back(catalogue.list[catalogue.variants[chosen].explanation].name);
  return out;
}

}  // namespace abbe::diagnose
