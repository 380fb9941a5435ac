#include "engine/diagnose/findings/members.hpp"

#include <algorithm>
#include <cmath>

#include "engine/diagnose/findings/belief.hpp"
#include "engine/diagnose/findings/carried.hpp"
#include "engine/diagnose/findings/known_effect.hpp"
#include "engine/diagnose/findings/parameters.hpp"

namespace abbe::diagnose {

namespace {

/// How probable a member of a finding's set is, up to a factor that all members share.
double weight(const Explanations& all, const Finding& f, int member) {
  const std::vector<double>& bayes = f.evidence.log_bayes;
  return all.list[member].prior * std::exp(bayes[member] - bayes[f.explanation]);
}

double weight_of_all(const Explanations& all, const Finding& f) {
  double sum = 0;
  for (const int member : f.set) sum += weight(all, f, member);
  return sum;
}

/// Whether the touches show something of it, and of a displacement more than a hundredth: else what little they show is
/// magnified by a lever that is too short.
bool shows(const Effect& effect, const FoundSize& size) {
  constexpr double kNothing_um = 1e-3, kShort = 100;
  const auto magnified = [&](const DiagnosedParameter& found) {
    const auto p = std::find_if(effect.parameters.begin(), effect.parameters.end(),
                                [&](const EffectParameter& of) { return of.name == found.name; });
    return p != effect.parameters.end() && p->linear && p->unit == "um" &&
        std::abs(found.value) > kShort * size.largest_um;
  };
  return size.largest_um > kNothing_um && std::none_of(size.parameters.begin(), size.parameters.end(), magnified);
}

/// Whether a machine can have what was found of a member: where its file has the effect already, both together.
bool possible(const Case& c, const SearchResult& result, std::size_t k, int member) {
  const Finding& f = result.findings[k];
  const FoundSize size = estimate_size(c, result, k, member);
  const std::vector<DiagnosedParameter>& found = size.parameters;
  const Effect& effect = *c.explanations.list[member].effect;
  if (!shows(effect, size)) return false;
  if (c.explanations.variants[f.variant_of(member)].change.gone()) return all_plausible(found);
  const auto known = known_effect(*c.machine, effect, setting_from(effect, found));
  if (!known) return all_plausible(found);
  return known->gone || plausible(effect, nearest_possible(effect, known->now));
}

/// Adds the likeliest of the other effects until a set holds kCredible of what is believed of those that were not
/// struck out.
void fill_up(const Case& c, Finding& f, const std::vector<int>& struck) {
  const auto in = [](const std::vector<int>& list, int k) {
    return std::find(list.begin(), list.end(), k) != list.end();
  };
  std::vector<std::pair<double, int>> others;
  double held = weight_of_all(c.explanations, f), all = held;
  for (int k = 0; k < static_cast<int>(c.explanations.list.size()); ++k) {
    if (!c.explanations.list[k].effect || in(f.set, k) || in(struck, k) || !says_something(f.evidence, k)) continue;
    others.emplace_back(-weight(c.explanations, f, k), k);
    all += weight(c.explanations, f, k);
  }
  std::sort(others.begin(), others.end());
  const double probability_of_weight = f.probability / held;
  for (const auto& [minus_weight, k] : others) {
    if (held >= kCredible * all) break;
    held -= minus_weight;
    f.set.push_back(k);
  }
  f.probability = probability_of_weight * held;
}

}  // namespace

bool judged(const Case& c, const Finding& f) {
  constexpr double kMostly = 0.8;
  double open = 0;
  for (const int k : f.set)
    if (c.explanations.list[k].missing) open += weight(c.explanations, f, k);
  return open < kMostly * weight_of_all(c.explanations, f);
}

double share_of(const Explanations& all, const Finding& f, int member) {
  return weight(all, f, member) / weight_of_all(all, f);
}

double belief_in_first(const Explanations& all, const Finding& f) {
  return f.probability * share_of(all, f, f.set.front());
}

bool possible_first(const Case& c, const SearchResult& result, std::size_t k) {
  return possible(c, result, k, result.findings[k].explanation);
}

void put_judged_members_first(const Case& c, SearchResult& result) {
  const auto can_be = [&](int m) { return !c.explanations.list[m].missing; };
  for (Finding& f : result.findings) {
    if (!judged(c, f) || can_be(f.set.front())) continue;
    std::stable_partition(f.set.begin(), f.set.end(), can_be);
    f.put_first(f.set.front());
  }
}

void drop_impossible_members(const Case& c, SearchResult& result) {
  for (std::size_t k = 0; k < result.findings.size(); ++k) {
    const Finding as_found = result.findings[k];
    const double all = weight_of_all(c.explanations, as_found);
    double dropped = 0;
    std::vector<int> struck;
    Finding& f = result.findings[k];
    const auto strike = [&](std::size_t at) {
      struck.push_back(f.set[at]);
      dropped += weight(c.explanations, as_found, f.set[at]);
      f.set.erase(f.set.begin() + static_cast<std::ptrdiff_t>(at));
      // of all that were in question before, those outside the set too
      const double impossible = as_found.probability * dropped / all;
      f.probability = (as_found.probability - impossible) / (1 - impossible);
    };
    bool possible_head = possible(c, result, k, f.explanation);
    while (!possible_head && f.set.size() > 1) {
      strike(0);
      f.put_first(f.set.front());
      possible_head = possible(c, result, k, f.explanation);
    }
    if (!possible_head) {
      f = as_found;
      continue;
    }
    // The others of those that are told with a size of their own.
    for (std::size_t at = 1; at < std::min(f.set.size(), kSized);) {
      if (possible(c, result, k, f.set[at]))
        ++at;
      else
        strike(at);
    }
    if (!struck.empty()) fill_up(c, f, struck);
  }
}

void take_in_runner_up(const Case& c, const EvidenceSearch& first, const Diagnosis& d, SearchResult& result) {
  // nats: below it "not worth more than a bare mention" (Kass, Raftery, J. Am. Stat. Assoc. 90 (1995) 773)
  constexpr double kBareMention = 1;
  constexpr double kLeastBelief = 0.01;  // a hundred times less usual needs no measurement to be told apart
  const bool as_well =
      d.runner_up && d.improvement && d.runner_up->log_score_gain >= d.improvement->log_score_gain - kBareMention;
  if (!as_well || result.findings.size() != 1 || result.other) return;
  Finding& f = result.findings.front();
  const auto& list = c.explanations.list;
  const auto found = std::find_if(list.begin(), list.end(),
                                  [&](const Explanation& e) { return e.name == d.runner_up->members.front(); });
  const int member = static_cast<int>(found - list.begin());
  const auto fits = [&](int variant) {
    const Information i = first.information(variant);
    return 0.5 * explained(i.g, i.u)(0) - double(i.u.size());  // each column fits something of the noise
  };
  const double belief = f.probability * share_of(c.explanations, f, member);
  if (belief < kLeastBelief || fits(f.variant_of(member)) < fits(f.variant) - kBareMention ||
      !possible(c, result, 0, member))
    return;
  f.probability += belief;
  f.set.push_back(member);
}

std::vector<DiagnosedMember> members_of(const Case& c, const SearchResult& result, std::size_t k,
                                        DiagnosedEffect& told) {
  const Finding& f = result.findings[k];
  const double all = weight_of_all(c.explanations, f);
  std::vector<DiagnosedMember> out;
  for (const int m : f.set) {
    out.push_back({told.probability * weight(c.explanations, f, m) / all, {}, {}});
    if (m == f.explanation) {
      out.back().parameters = told.parameters;
      out.back().largest_um = told.largest_um;
    } else if (out.size() <= kSized) {
      FoundSize size = estimate_size(c, result, k, m);
      out.back().parameters = std::move(size.parameters);
      out.back().largest_um = size.largest_um;
      told.change[out.size() - 1] = size.change;
    }
  }
  return out;
}

}  // namespace abbe::diagnose
