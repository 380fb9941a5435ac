#include "engine/diagnose/findings/belief.hpp"

#include <algorithm>

namespace abbe::diagnose {

bool predicts_better(const std::optional<Improvement>& i) {
  return i && i->log_score_gain > i->se && i->rms_after_um <= i->rms_before_um;
}

bool all_plausible(const std::vector<DiagnosedParameter>& parameters) {
  return std::all_of(parameters.begin(), parameters.end(), [](const DiagnosedParameter& p) { return p.plausible; });
}

}  // namespace abbe::diagnose
