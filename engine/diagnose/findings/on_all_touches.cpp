#include "engine/diagnose/findings/on_all_touches.hpp"

#include <numeric>

#include "engine/diagnose/baseline/length_errors.hpp"
#include "engine/diagnose/explanations/catalogue.hpp"
#include "engine/diagnose/model/precision.hpp"

namespace abbe::diagnose {

std::vector<Matrix> on_all_touches(const Case& c, const std::vector<Finding>& findings) {
  std::vector<int> all(c.touches.touches.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<Matrix> out;
  for (const Finding& f : findings) {
    const Effect& effect = *c.explanations.list[f.explanation].effect;
    out.push_back(variant_like(c.explanations.variants[f.variant], effect, c.touches, all).signature);
  }
  return out;
}

std::optional<LengthError> beyond_beside_names(const Case& c, const SearchResult& result) {
  LinearModel left = c.baseline.model;
  if (!result.findings.empty()) {
    const std::vector<Matrix> found = on_all_touches(c, result.findings);
    const Matrix named = side_by_side(left.y.size(), pointers_to(found));
    const Precision precision(likelier_ensemble(c, c.model), result.hyper_of_likelier);
    const Precision::Seen seen = precision.seen(named(c.rows, Eigen::all));
    left.y -= named * Cholesky(inner(seen, seen), 1 / (kWidest * kWidest)).solve(inner(seen, precision.y()));
  }
  return beyond_specification(worst_length(c.touches, without_placement(left), c.machine->specification, c.masked),
                              *c.machine);
}

}  // namespace abbe::diagnose
