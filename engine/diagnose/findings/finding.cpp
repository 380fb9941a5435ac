#include "engine/diagnose/findings/finding.hpp"

#include <algorithm>
#include <cmath>

#include "engine/diagnose/model/log_sums.hpp"

namespace abbe::diagnose {

std::vector<double> probabilities(const Explanations& explanations, const Evidence& evidence) {
  std::vector<double> log_p;
  for (std::size_t k = 0; k < explanations.list.size(); ++k)
    log_p.push_back(std::log(explanations.list[k].prior) + evidence.log_bayes[k]);
  const double total = log_sum_exp(log_p);
  for (double& p : log_p) p = std::exp(p - total);
  return log_p;
}

std::vector<int> likeliest_first(const Explanations& explanations, const std::vector<double>& p, bool catalogue) {
  std::vector<int> order;
  for (std::size_t k = 0; k < p.size(); ++k)
    if ((explanations.list[k].effect != nullptr) == catalogue) order.push_back(static_cast<int>(k));
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return p[a] > p[b]; });
  return order;
}

std::vector<int> best_variants(const Explanations& explanations, const Evidence& evidence) {
  std::vector<int> out;
  for (std::size_t k = 0; k < explanations.list.size(); ++k)
    out.push_back(explanations.list[k].variants.empty() ? -1
                                                        : best_variant(explanations, static_cast<int>(k), evidence));
  return out;
}

int best_variant(const Explanations& all, int explanation, const Evidence& evidence) {
  const std::vector<int>& variants = all.list[explanation].variants;
  return *std::max_element(variants.begin(), variants.end(),
                           [&](int a, int b) { return log_belief(all, evidence, a) < log_belief(all, evidence, b); });
}

bool says_something(const Evidence& evidence, int explanation) {
  constexpr double kSaysNothing = 0.4;  // nats
  return evidence.log_bayes[explanation] >= kSaysNothing;
}

CredibleSet credible_set(const Explanations& all, const Evidence& evidence, bool catalogue) {
  const std::vector<double> p = probabilities(all, evidence);
  std::vector<int> order = likeliest_first(all, p, catalogue);
  std::erase_if(order, [&](int k) { return k != order.front() && !says_something(evidence, k); });
  double total = 0;
  for (const int k : order) total += p[k];
  CredibleSet out;
  if (order.empty()) return out;
  out.explanation = order.front();
  for (const int k : order) {
    if (!out.set.empty() && out.probability >= kCredible * total) break;
    out.set.push_back(k);
    out.probability += p[k];
  }
  return out;
}

Finding finding_of(const Explanations& all, const Evidence& evidence, bool catalogue) {
  Finding f;
  static_cast<CredibleSet&>(f) = credible_set(all, evidence, catalogue);
  f.evidence = evidence;
  if (f.explanation < 0) return f;
  f.variant = best_variant(all, f.explanation, evidence);
  f.best = best_variants(all, evidence);
  return f;
}

Finding finding_of_one(const Explanations& all, const Evidence& evidence, int explanation) {
  Finding f;
  f.explanation = explanation;
  f.set = {explanation};
  f.probability = probabilities(all, evidence)[explanation];
  f.variant = best_variant(all, explanation, evidence);
  f.evidence = evidence;
  f.best = best_variants(all, evidence);
  return f;
}

bool likelier(const Finding& name, const Finding& pattern, double times) {
  return name.explanation >= 0 && name.probability >= times * pattern.probability;
}

bool leaves_less(double pattern_adequacy, double name_adequacy) {
  constexpr double kClearly = 3;
  return pattern_adequacy >= kInadequate && pattern_adequacy >= kClearly * name_adequacy;
}

}  // namespace abbe::diagnose
