#include "engine/diagnose/planning/question.hpp"

#include <algorithm>
#include <set>

namespace abbe::diagnose {

Question question_of(const SearchResult& result) {
  constexpr std::size_t kMost = 8;
  for (std::size_t i = 0; i < result.findings.size(); ++i) {
    const Finding& f = result.findings[i];
    if (f.set.size() < 2) continue;
    Question q{{f.set.begin(), f.set.begin() + static_cast<std::ptrdiff_t>(std::min(f.set.size(), kMost))},
               result.findings};
    q.beside.erase(q.beside.begin() + static_cast<std::ptrdiff_t>(i));
    return q;
  }
  return {};
}

std::vector<Question> questions_of(const Case& c, const std::vector<Detectable>& detectable, std::size_t most) {
  const auto index = [&](const std::string& name) {
    for (std::size_t k = 0; k < c.explanations.list.size(); ++k)
      if (c.explanations.list[k].name == name) return static_cast<int>(k);
    return -1;
  };
  const auto expected = [&](const std::string& name) {
    const auto d =
        std::find_if(detectable.begin(), detectable.end(), [&](const Detectable& x) { return x.effect == name; });
    if (d == detectable.end()) return 0.0;
    const auto& parameters = c.explanations.list[index(name)].effect->parameters;
    const auto p = std::find_if(parameters.begin(), parameters.end(),
                                [&](const EffectParameter& x) { return x.name == d->parameter; });
    return std::min(1.0, p->typical / d->detect);
  };
  std::vector<std::pair<double, std::vector<std::string>>> open;
  for (const Detectable& d : detectable) {
    if (d.confounded_with.empty()) continue;
    std::vector<std::string> alike = d.confounded_with;
    alike.insert(alike.begin(), d.effect);
    double sum = 0;
    for (const std::string& name : alike) sum += expected(name);
    open.emplace_back(expected(d.effect) * sum, std::move(alike));
  }
  std::stable_sort(open.begin(), open.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Question> out;
  std::set<std::string> asked;
  for (const auto& [worth, alike] : open) {
    if (out.size() == most || asked.count(alike.front()) > 0) continue;
    asked.insert(alike.begin(), alike.end());
    out.emplace_back();
    for (const std::string& name : alike) out.back().rivals.push_back(index(name));
  }
  return out;
}

}  // namespace abbe::diagnose
