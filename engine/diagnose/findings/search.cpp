// Detect, name, remove, and look again: every round tests the whole catalogue and OTHER on what the findings
// before leave unexplained.
#include "engine/diagnose/findings/search.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "engine/base/ids.hpp"
#include "engine/diagnose/explanations/patterns/patterns.hpp"
#include "engine/diagnose/explanations/refine.hpp"
#include "engine/diagnose/findings/belief.hpp"
#include "engine/diagnose/findings/displacements.hpp"
#include "engine/diagnose/findings/members.hpp"
#include "engine/diagnose/model/precision.hpp"
#include "engine/diagnose/model/restricted_likelihood.hpp"
#include "engine/lanes/random.hpp"

namespace abbe::diagnose {

namespace {

constexpr int kRounds = 3;
/// Simulated recordings of a round.
constexpr int kReplicates = 300;
/// What is left after a finding is never quite nothing: the catalogue is simpler than the world. A second
/// name needs more.
constexpr double kLaterAlarm = 1e-3;

/// The likeliest variant of the likeliest explanation.
int likeliest_variant(const Explanations& explanations, const Evidence& evidence) {
  const std::vector<double> p = probabilities(explanations, evidence);
  return best_variant(explanations, static_cast<int>(std::max_element(p.begin(), p.end()) - p.begin()), evidence);
}

struct Named {
  Finding name, pattern;
};

/// What a round has found, on a grid that is refined where the recording asks for it. The grid of the case
/// stays as it is, for what is sought next; the variants of the name that count are appended to it.
Named named_on_finer_grid(Case& c, EvidenceSearch& search) {
  constexpr double kVariantOutOfQuestion = 12;  // nats
  Explanations fine = c.explanations;
  refine(c, fine, search);
  const Evidence& evidence = search.evidence();
  Named out{finding_of(fine, evidence, true), finding_of(fine, evidence, false)};
  out.name.best = out.pattern.best = best_variants(c.explanations, evidence);
  ABBE_CHECK(out.name.explanation >= 0);  // the catalogue has effects that need nothing
  const int likeliest = out.name.variant;
  const double least = log_belief(fine, evidence, likeliest) - kVariantOutOfQuestion;
  for (const int b : fine.list[out.name.explanation].variants) {
    if (log_belief(fine, evidence, b) < least) continue;
    if (b == likeliest) out.name.variant = static_cast<int>(c.explanations.variants.size());
    out.name.variants.push_back(static_cast<int>(c.explanations.variants.size()));
    c.explanations.variants.push_back(std::move(fine.variants[b]));
  }
  return out;
}

double log_belief(const Case& c, const Finding& f) {
  return std::log(c.explanations.list[f.explanation].prior) + f.evidence.log_bayes[f.explanation];
}

/// The recording with what was found taken out. Its noise is fitted again: the first fit took the mismatch for noise.
EvidenceSearch rest_of(const Case& c, const std::vector<const Matrix*>& found) {
  const LinearModel model = with_free(c.model, found);
  return {model, estimate(model), c.explanations};
}

double alarm_of(int round) { return round == 0 ? kAlarm : kLaterAlarm; }

struct Round {
  Evidence evidence;
  std::vector<Evidence> null;
  double p = 1;
};

Round round(const Case& c, const EvidenceSearch& search, int number) {
  Round r{search.evidence(), {}, 1};
  // Beside the likeliest explanation: a mismatch has tails too.
  const int likeliest = likeliest_variant(c.explanations, r.evidence);
  const NoiseLaw law(search.residuals_beside(c.explanations.variants[likeliest]));
  begins(c.options.progress,
         number > 0 ? "simulated recordings without what was found" : "simulated recordings without a mismatch");
  r.null = search.bootstrap(r.evidence.statistic, law, {kReplicates, alarm_of(number)},
                            seed_of(c.options.seed, static_cast<std::uint64_t>(number)), c.options.threads);
  std::vector<double> simulated;
  for (const Evidence& e : r.null) simulated.push_back(e.statistic);
  r.p = tail_probability(r.evidence.statistic, std::move(simulated));
  return r;
}

/// The likeliest names but the first, each by itself, on the grid of the case.
std::vector<Finding> second_thoughts(const Case& c, const Evidence& evidence, int first) {
  constexpr std::size_t kMost = 3;
  const std::vector<double> p = probabilities(c.explanations, evidence);
  std::vector<Finding> out;
  for (const int k : likeliest_first(c.explanations, p, true)) {
    if (k == first) continue;
    if (out.size() == kMost) break;
    out.push_back(finding_of_one(c.explanations, evidence, k));
  }
  return out;
}

/// The name that with another one beside it says most, if the two say more than a pattern alone, though no name
/// by itself does. Of two effects at once neither need be the likeliest name.
std::optional<Finding> first_of_two(const Case& c, std::vector<Finding> before, const Finding& likeliest,
                                    const Evidence& evidence, const Finding& pattern, int number) {
  std::vector<Finding> names = second_thoughts(c, evidence, likeliest.explanation);
  names.insert(names.begin(), likeliest);
  std::optional<Finding> best;
  double most = log_belief(c, pattern);
  for (const Finding& name : names) {
    before.push_back(name);
    const Evidence rest = rest_of(c, signatures_of(c, before)).evidence();
    before.pop_back();
    const Finding partner = finding_of(c.explanations, rest, true);
    if (partner.probability < finding_of(c.explanations, rest, false).probability) continue;
    const double both = log_belief(c, name) + log_belief(c, partner);
    if (both > most) most = both, best = name;
  }
  if (!best) return std::nullopt;
  before.push_back(*best);
  return round(c, rest_of(c, signatures_of(c, before)), number + 1).p <= kLaterAlarm ? best : std::nullopt;
}

/// What the others leave for a finding to explain: the other names, and the pattern beside them.
EvidenceSearch left_by_others(const Case& c, const std::vector<Finding>& all, std::size_t which,
                              const std::optional<Finding>& beside) {
  SearchResult others;
  others.findings = all;
  others.findings.erase(others.findings.begin() + static_cast<std::ptrdiff_t>(which));
  others.other = beside;
  return rest_of(c, signatures_of(c, others));
}

/// Names a finding again, given what was found after it, which may have taken over part of it. Where a pattern
/// is likelier now than any name, it is that pattern. The name of before has fine variants already; its rivals get
/// theirs here, or it would be preferred to what does the same to these touches.
struct Renamed {
  Finding finding;
  bool pattern = false;
};
Renamed renamed(Case& c, const std::vector<Finding>& all, std::size_t which, const std::optional<Finding>& beside) {
  EvidenceSearch rest = left_by_others(c, all, which, beside);
  auto [name, pattern] = named_on_finer_grid(c, rest);
  return name.probability >= pattern.probability ? Renamed{std::move(name), false} : Renamed{std::move(pattern), true};
}

/// What a pattern in the place of the last finding leaves: the probability that chance leaves as much.
double adequacy_with(const Case& c, std::vector<Finding> findings, const Finding& pattern) {
  findings.back() = pattern;
  return round(c, rest_of(c, signatures_of(c, findings)), kRounds + 2).p;
}

/// Round after round, until nothing is left or what is left has no name.
SearchResult found_in_rounds(Case& c, EvidenceSearch& first) {
  SearchResult result;
  std::optional<Finding> instead;  // of the last name: the pattern without a name
  for (int number = 0; number <= kRounds; ++number) {
    std::optional<EvidenceSearch> rest;
    if (number > 0) rest.emplace(rest_of(c, signatures_of(c, result.findings)));
    EvidenceSearch& here = rest ? *rest : first;
    Round r = round(c, here, number);
    if (number == 0) {
      result.p_value = r.p;
      result.on_grid = r.evidence;
      result.null = std::move(r.null);
    } else {
      result.adequacy = r.p;
    }
    if (r.p > alarm_of(number) || number == kRounds) break;
    auto [named, other] = named_on_finer_grid(c, here);
    std::optional<Finding> name;
    if (likelier(named, other, kNamed))
      name = std::move(named);
    else if (number + 1 < kRounds)
      name = first_of_two(c, result.findings, named, r.evidence, other, number);
    if (!name) {
      result.other = std::move(other);
      return result;
    }
    result.findings.push_back(std::move(*name));
    instead = std::move(other);
  }
  if (result.adequacy < kInadequate && !likelier(result.findings.back(), *instead, kNamedInDoubt) &&
      leaves_less(adequacy_with(c, result.findings, *instead), result.adequacy)) {
    result.nearest = std::move(result.findings.back());
    result.findings.pop_back();
    result.other = std::move(instead);
  }
  return result;
}

/// The finer variants of what was found take the place of the coarse ones. Which explanations have them now.
std::set<int> keep_variants(Case& c, const std::vector<Finding>& findings) {
  std::set<int> refined;
  for (const Finding& f : findings) {
    if (f.variants.empty()) continue;
    std::vector<int>& variants = c.explanations.list[f.explanation].variants;
    if (refined.insert(f.explanation).second) variants.clear();
    variants.insert(variants.end(), f.variants.begin(), f.variants.end());
  }
  return refined;
}

/// Where a pattern alone is as good as effects with a pattern beside them, the effects were not there.
void drop_names_beside_a_pattern(const Case& c, SearchResult& result) {
  if (!result.other || result.findings.empty()) return;
  const Finding alone = finding_of(c.explanations, result.first, false);
  double together = log_belief(c, *result.other);
  for (const Finding& f : result.findings) together += log_belief(c, f);
  if (log_belief(c, alone) <= together) return;
  result.findings.clear();
  result.other = alone;
}

/// The share of what the recording has beyond chance, in squares, that the findings leave.
double left_share(const Case& c, const SearchResult& result) {
  const LinearModel rest = with_free(c.model, signatures_of(c, result));
  const Hyperparameters hyper = estimate(rest);
  const auto beyond_chance = [&](const LinearModel& m) {
    const Precision precision(m, hyper);
    return std::max(1.0, inner(precision.y(), precision.y())(0, 0) - double(m.y.size()));
  };
  return beyond_chance(rest) / beyond_chance(c.model);
}

/// What the names leave is a mismatch of its own, but no further name was found for it: a pattern. Of a large effect
/// the catalogue's simple law leaves something too, which is little beside what it explains.
void add_what_names_leave(const Case& c, SearchResult& result) {
  constexpr double kLittle = 0.05;
  if (result.findings.empty() || result.other || result.adequacy > kLaterAlarm || left_share(c, result) < kLittle)
    return;
  result.other = finding_of(c.explanations, rest_of(c, signatures_of(c, result.findings)).evidence(), false);
  drop_names_beside_a_pattern(c, result);
}

/// A name that is not believed, and that nothing speaks for beside the pattern, has only led to the pattern.
void drop_name_that_led_to_a_pattern(const Case& c, SearchResult& result) {
  if (!result.other || result.findings.size() != 1 || result.findings.front().probability >= kDoubted) return;
  if (left_by_others(c, result.findings, 0, result.other).evidence().statistic > 0) return;
  result.findings.clear();
  result.other = finding_of(c.explanations, result.first, false);
}

/// Which of the names of a set is told, and what is left beside it.
void choose_first_members(Case& c, SearchResult& result) {
  const auto first_members = [&] {
    std::vector<int> list;
    for (const Finding& f : result.findings) list.push_back(f.explanation);
    return list;
  };
  const std::vector<int> before = first_members();
  put_judged_members_first(c, result);
  drop_impossible_members(c, result);
  if (first_members() == before) return;
  result.adequacy = round(c, rest_of(c, signatures_of(c, result.findings)), kRounds + 3).p;
  fit_beside_findings(c, result);
}

bool has_period(const Effect& effect) {
  return std::any_of(effect.parameters.begin(), effect.parameters.end(), [](const EffectParameter& p) {
    return p.sought == Sought::signal_period || p.sought == Sought::wavelength || p.sought == Sought::period;
  });
}

/// A period fits whatever differs between a few places, as long as it may be as large as it likes. One of a size that no
/// such effect has is none, and what it was taken for has no name.
void drop_impossible_periods(Case& c, SearchResult& result) {
  std::vector<Finding> left;
  for (std::size_t k = 0; k < result.findings.size(); ++k) {
    const Finding& f = result.findings[k];
    if (has_period(*c.explanations.list[f.explanation].effect) && !possible_first(c, result, k))
      result.nearest = f, result.nearest_impossible = true;
    else
      left.push_back(f);
  }
  if (left.size() == result.findings.size()) return;
  result.findings = std::move(left);
  result.other = finding_of(c.explanations, rest_of(c, signatures_of(c, result.findings)).evidence(), false);
  fit_beside_findings(c, result);
}

/// How the size of each name differs between the touches.
void compare_sizes(const Case& c, SearchResult& result) {
  const std::vector<const Matrix*> found = signatures_of(c, result);
  for (std::size_t k = 0; k < result.findings.size(); ++k) {
    Finding& f = result.findings[k];
    if (!c.explanations.list[f.explanation].effect->only_spread)
      f.sizes = size_difference(c, found, k, result.hyper_of_likelier);
  }
}

/// A name by itself whose size clearly differs is none: what it does, with a size of its own for each group of touches,
/// is a pattern over what they were grouped by.
void drop_name_of_several_sizes(Case& c, EvidenceSearch& first, SearchResult& result) {
  if (result.findings.size() != 1 || result.other) return;
  constexpr double kOtherSizes = 2 * kOneSize;
  const std::optional<SizeDifference>& sizes = result.findings.front().sizes;
  if (!sizes || sizes->p >= kLaterAlarm || sizes->share < kOtherSizes) return;
  const std::size_t before = c.explanations.variants.size();
  add_pattern(c.explanations, sizes->factor,
              c.explanations.list[result.findings.front().explanation].name + ", not of one size",
              by_group(*signatures_of(c, result.findings).front(), sizes->group));
  first.extend(c.explanations, before);
  result.first = first.evidence();
  result.nearest = std::move(result.findings.front());
  result.findings.clear();
  result.other = finding_of_one(c.explanations, result.first, static_cast<int>(c.explanations.list.size()) - 1);
  fit_beside_findings(c, result);
}

/// A finding that later ones have taken over altogether is none: beside them nothing speaks for it.
void drop_needless(const Case& c, SearchResult& result) {
  while (result.findings.size() > 1) {
    std::vector<double> left;
    for (std::size_t k = 0; k < result.findings.size(); ++k)
      left.push_back(left_by_others(c, result.findings, k, result.other).evidence().statistic);
    const auto least = std::min_element(left.begin(), left.end());
    if (*least > 0) return;
    result.findings.erase(result.findings.begin() + (least - left.begin()));
  }
}

/// Along an axis and along any direction is one fault, too.
bool same_fault(const Case& c, const Finding& a, const Finding& b) {
  if (a.explanation != b.explanation) return false;
  Variant one = c.explanations.variants[a.variant], other = c.explanations.variants[b.variant];
  if (one.axis < 0 || other.axis < 0) one.axis = other.axis;
  return alike(one, other);
}

/// Names every finding again, given all others as they are by then. Two rounds may have named one fault twice: then one
/// name is enough.
void name_again(Case& c, SearchResult& result) {
  std::vector<Finding>& all = result.findings;
  bool two_patterns = false;
  for (std::size_t k = 0; k < all.size();) {
    auto [f, pattern] = renamed(c, all, k, result.other);
    const bool known = std::any_of(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(k),
                                   [&](const Finding& other) { return same_fault(c, other, f); });
    if (!pattern && !known) {
      all[k++] = std::move(f);
      continue;
    }
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(k));
    if (pattern && result.other) two_patterns = true;
    if (pattern && !result.other) result.other = std::move(f);
  }
  if (two_patterns)
    result.other = finding_of(c.explanations, rest_of(c, signatures_of(c, result.findings)).evidence(), false);
}

/// Whether the names are other ones than before.
bool others(const Case& c, const std::vector<Finding>& now, const std::vector<Finding>& before) {
  return !std::equal(now.begin(), now.end(), before.begin(), before.end(),
                     [&](const Finding& a, const Finding& b) { return same_fault(c, a, b); });
}

}  // namespace

void fit_beside_findings(Case& c, SearchResult& result) {
  const std::vector<const Matrix*> found = signatures_of(c, result);
  result.hyper = c.hyper;
  if (!found.empty()) {
    const LinearModel rest = with_free(c.model, found);
    result.hyper = estimate(rest);
    // asked of the machine alone: any one explanation will do beside it
    c.rough = EvidenceSearch(rest, result.hyper, only(c.explanations, {0})).more_likely_rough();
  }
  result.hyper_of_likelier = c.rough ? estimate(with_free(likelier_ensemble(c, c.model), found)) : result.hyper;
}

SearchResult search(Case& c, EvidenceSearch& first) {
  const std::size_t grid = c.explanations.variants.size();
  const std::vector<Explanation> on_grid = c.explanations.list;
  SearchResult result = found_in_rounds(c, first);
  const std::vector<Finding> in_rounds = result.findings;
  const auto keep = [&] {
    result.refined = keep_variants(c, result.findings);
    first.extend(c.explanations, grid);
    result.first = first.evidence();
  };
  keep();
  drop_names_beside_a_pattern(c, result);
  const bool several = result.findings.size() > 1;
  drop_needless(c, result);
  if (several) {
    c.explanations.list = on_grid;  // all variants are rivals again
    name_again(c, result);
    keep();
  }
  if (several && !result.findings.empty() && others(c, result.findings, in_rounds))
    result.adequacy = round(c, rest_of(c, signatures_of(c, result.findings)), kRounds + 1).p;
  add_what_names_leave(c, result);
  drop_name_that_led_to_a_pattern(c, result);
  put_largest_first(c, result.findings);
  fit_beside_findings(c, result);
  choose_first_members(c, result);
  drop_impossible_periods(c, result);
  compare_sizes(c, result);
  drop_name_of_several_sizes(c, first, result);
  return result;
}

void put_largest_first(const Case& c, std::vector<Finding>& findings) {
  if (findings.size() < 2) return;
  std::vector<std::pair<double, std::size_t>> order;
  for (const Vector& d : displacements(c, signatures_of(c, findings))) order.emplace_back(-d.norm(), order.size());
  std::sort(order.begin(), order.end());
  const std::vector<Finding> found = std::exchange(findings, {});
  for (const auto& [minus_um, k] : order) findings.push_back(found[k]);
}

std::vector<const Matrix*> signatures_of(const Case& c, const std::vector<Finding>& findings) {
  std::vector<const Matrix*> list;
  for (const Finding& f : findings) list.push_back(&c.explanations.variants[f.variant].signature);
  return list;
}

std::vector<const Matrix*> signatures_of(const Case& c, const SearchResult& result) {
  std::vector<const Matrix*> list = signatures_of(c, result.findings);
  if (result.other) list.push_back(&c.explanations.variants[result.other->variant].signature);
  return list;
}

}  // namespace abbe::diagnose
