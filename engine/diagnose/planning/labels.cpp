#include "engine/diagnose/planning/labels.hpp"

#include <fmt/format.h>

#include <cctype>
#include <set>

namespace abbe::diagnose {

namespace {

std::string without_other_characters(const std::string& name) {
  std::string out;
  for (const char c : name)
    out += std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '.' ? c : '_';
  return out;
}

}  // namespace

std::vector<std::string> dmis_labels(const std::vector<std::string>& names) {
  std::vector<std::string> out(names.size());
  std::set<std::string> taken;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (without_other_characters(names[i]) == names[i] && taken.insert(names[i]).second) out[i] = names[i];
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!out[i].empty()) continue;
    const std::string plain = without_other_characters(names[i]);
    out[i] = plain;
    for (int number = 2; !taken.insert(out[i]).second; ++number) out[i] = fmt::format("{}_{}", plain, number);
  }
  return out;
}

Labels labels_of(const Longer& longer) {
  std::map<std::string, std::set<int>> tips;
  for (std::size_t k = longer.first; k < longer.touches.touches.size(); ++k) {
    const StylusScene& s = longer.touches.touches[k].scene.stylus;
    tips[std::string(s.name)].insert(s.tip_ordinal);
  }
  std::vector<std::string> names;
  std::vector<int> ordinal;
  for (const auto& [name, ordinals] : tips)
    for (const int k : ordinals) {
      names.push_back(ordinals.size() == 1 ? name : fmt::format("{}_{}", name, k));
      ordinal.push_back(k);
    }
  Labels out{dmis_labels(longer.touches.features), {}};
  const std::vector<std::string> labels = dmis_labels(names);
  for (std::size_t i = 0; i < labels.size(); ++i) out.tips[ordinal[i]] = labels[i];
  return out;
}

}  // namespace abbe::diagnose
