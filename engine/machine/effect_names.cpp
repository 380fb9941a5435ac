#include "engine/machine/effect_names.hpp"

#include <map>

namespace abbe {

std::vector<std::string> effect_names(const std::vector<EffectSetting>& settings) {
  std::vector<std::string> names;
  std::map<std::string, int> count;
  for (const EffectSetting& setting : settings) {
    const int k = ++count[setting.name];
    names.push_back(k == 1 ? setting.name : setting.name + " #" + std::to_string(k));
  }
  return names;
}

}  // namespace abbe
