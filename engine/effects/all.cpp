// The list of effects, in the order of the catalogue. A new effect is one file and one line in the all.cpp of
// its family.
#include <algorithm>

#include "engine/effects/effect.hpp"
#include "engine/effects/families.hpp"

namespace abbe {

std::span<const Effect* const> effects() {
  static const std::vector<const Effect*> list = [] {
    std::vector<const Effect*> all;
    for (const auto family :
         {thermal_effects(), probe_effects(), head_effects(), machine_effects(), part_effects(), noise_effects()})
      all.insert(all.end(), family.begin(), family.end());
    return all;
  }();
  return list;
}

const Effect* find_effect(std::string_view name) {
  for (const auto list : {effects(), empirical_effects()}) {
    const auto found = std::find_if(list.begin(), list.end(), [&](const Effect* e) { return e->name == name; });
    if (found != list.end()) return *found;
  }
  return nullptr;
}

std::optional<std::size_t> moment_of(const Effect& effect) {
  for (std::size_t p = 0; p < effect.parameters.size(); ++p)
    if (effect.parameters[p].sought == Sought::moment) return p;
  return std::nullopt;
}

bool is_noise(std::string_view name) {
  const Effect* const effect = find_effect(name);
  return effect && is_noise(*effect);
}

}  // namespace abbe
