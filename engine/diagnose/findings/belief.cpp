#include "engine/diagnose/findings/belief.hpp"

#include <algorithm>

namespace abbe::diagnose {

bool predicts_better(const std::optional<Improvement>& i) {
  return i && i->log_score_gain > i->se && i->rms_after_um <= i->rms_before_um;
}

bool all_plausible(const std::vector<DiagnosedParameter>& parameters) {
  return std::all_of(parameters.begin(), parameters.end(), [](const DiagnosedParameter& p) { return p.plausible; });
}

bool none_is_sure(const Effect& effect, const std::vector<DiagnosedParameter>& told) {
  std::vector<const DiagnosedParameter*> sizes;
  for (const EffectParameter& p : effect.parameters)
    for (const DiagnosedParameter& size : told)
      if (p.linear && size.name == p.name) sizes.push_back(&size);
  return sizes.size() > 1 && std::all_of(sizes.begin(), sizes.end(), [](const DiagnosedParameter* size) {
           return size->low <= 0 && size->high >= 0;
         });
}

}  // namespace abbe::diagnose
