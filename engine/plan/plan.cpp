#include "engine/plan/plan.hpp"

namespace abbe::plan {

EvaluatedAs evaluated_as(const Plan& plan, const CharacteristicDef& c) {
  std::vector<std::string> labels{plan[c.tolerance].label};
  for (const FeatureId f : c.features) labels.push_back(plan[f].label);
  return {c.line, std::move(labels)};
}

}  // namespace abbe::plan
