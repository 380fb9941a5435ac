// What explains a mismatch: names of the catalogue, and patterns without one.
#pragma once

#include <set>

#include "engine/diagnose/case.hpp"
#include "engine/diagnose/findings/one_size.hpp"
#include "engine/diagnose/model/evidence.hpp"

namespace abbe::diagnose {

/// The likeliest variant of an explanation, given the data and what was believed of it before.
int best_variant(const Explanations&, int explanation, const Evidence&);

/// Whether data speak for an explanation by more than what is free already does.
bool says_something(const Evidence&, int explanation);

/// The smallest set of effects, or of patterns, that holds kCredible of the belief in its own kind.
struct CredibleSet {
  int explanation = -1;    ///< the likeliest; none where there are none of this kind
  std::vector<int> set;    ///< explanations, likeliest first
  double probability = 0;  ///< of the set
};
CredibleSet credible_set(const Explanations&, const Evidence&, bool catalogue);

/// One mismatch that the search has found.
struct Finding : CredibleSet {
  int variant = -1;                     ///< the likeliest variant of its likeliest explanation
  std::vector<int> variants;            ///< those of its explanation that count, on a finer grid; empty: all
  Evidence evidence;                    ///< given the findings before; of variants as they were numbered then
  std::vector<int> best;                ///< by explanation: the likeliest of the variants that the case had then
  std::optional<SizeDifference> sizes;  ///< of a name that has a law: how its size differs between touches

  int variant_of(int member) const { return member == explanation ? variant : best[member]; }
};

/// By the displacement that each makes, all together fitted by least squares: a round may find first a trifle that no
/// error of the machine explains, and then what a rougher machine might explain and is a hundred times as large.
void put_largest_first(const Case&, std::vector<Finding>&);

struct SearchResult {
  double p_value = 1;
  double adequacy = 1;              ///< p-value of what the findings leave; 1 without any
  std::vector<Finding> findings;    ///< of the catalogue
  std::optional<Finding> other;     ///< what the catalogue does not explain
  std::optional<Finding> nearest;   ///< the name that was doubted in favour of `other`
  bool nearest_impossible = false;  ///< for its size, which no such effect has
  std::set<int> refined;            ///< explanations that have finer variants in the case now
  Evidence first;                   ///< before any finding, with the finer variants of what was found
  Evidence on_grid;                 ///< that of the grid alone, as `null` is
  std::vector<Evidence> null;       ///< simulated, before any finding
  /// of the recording beside all that was found: a mismatch passes for noise and for larger errors
  Hyperparameters hyper;
  /// likewise, of the ensemble that the recording fits better (likelier_ensemble)
  Hyperparameters hyper_of_likelier;
};

/// `first`: the evidence of the whole recording. Effects that are found get finer variants, in the case and in `first`.
SearchResult search(Case&, EvidenceSearch& first);

/// The credible set with variants, of the variants that the evidence has seen.
Finding finding_of(const Explanations&, const Evidence&, bool catalogue);
/// A name must be so many times as likely as no name. One that leaves something of the mismatch, where a pattern
/// leaves less, must be far likelier: physics that the catalogue does not have looks like its nearest effect.
inline constexpr double kNamed = 1, kNamedInDoubt = 100;
bool likelier(const Finding& name, const Finding& pattern, double times);
/// From the probabilities that chance leaves as much as either: whether the pattern leaves no more than chance
/// does, and clearly less than the name. One that leaves as much only mirrors it, and says nothing against it.
bool leaves_less(double pattern_adequacy, double name_adequacy);

/// The signatures of findings; of all that was found, a pattern without a name too.
std::vector<const Matrix*> signatures_of(const Case&, const std::vector<Finding>&);
std::vector<const Matrix*> signatures_of(const Case&, const SearchResult&);

}  // namespace abbe::diagnose
