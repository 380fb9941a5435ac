#include "engine/diagnose/planning/noise_design.hpp"

#include "engine/diagnose/findings/noise/noise_property.hpp"

namespace abbe::diagnose {

void add_smallest_scatter(const Case& c, Diagnosis& out) {
  const ScatterDesign design(c);
  for (const NoiseProperty* property : noise_properties()) property->plan(design, out);
  for (const Effect* effect : effects())
    if (is_noise(*effect) && !tells_of(out, effect->name)) out.cannot_judge.push_back({std::string(effect->name)});
}

}  // namespace abbe::diagnose
