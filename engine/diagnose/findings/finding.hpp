// What one search of the evidence finds: the likeliest names, or patterns without one, and the set of those that may be it.
#pragma once

#include <optional>
#include <vector>

#include "engine/diagnose/findings/one_size.hpp"
#include "engine/diagnose/model/evidence.hpp"

namespace abbe::diagnose {

/// Probabilities of the explanations, given that one of them is there.
std::vector<double> probabilities(const Explanations&, const Evidence&);
/// The effects, or the patterns, by their probabilities.
std::vector<int> likeliest_first(const Explanations&, const std::vector<double>& probabilities, bool catalogue);
/// The likeliest variant of an explanation, given the data and what was believed of it before.
int best_variant(const Explanations&, int explanation, const Evidence&);
/// That of every explanation; -1 where one has none.
std::vector<int> best_variants(const Explanations&, const Evidence&);

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
  /// Takes another member of its set for the likeliest.
  void put_first(int member) { variant = variant_of(member), explanation = member; }
};

/// The credible set with variants, of the variants that the evidence has seen.
Finding finding_of(const Explanations&, const Evidence&, bool catalogue);
/// One explanation by itself.
Finding finding_of_one(const Explanations&, const Evidence&, int explanation);
/// A name must be so many times as likely as no name. One that leaves something of the mismatch, where a pattern
/// leaves less, must be far likelier: physics that the catalogue does not have looks like its nearest effect.
inline constexpr double kNamed = 1, kNamedInDoubt = 100;
bool likelier(const Finding& name, const Finding& pattern, double times);
/// From the probabilities that chance leaves as much as either: whether the pattern leaves no more than chance
/// does, and clearly less than the name. One that leaves as much only mirrors it, and says nothing against it.
bool leaves_less(double pattern_adequacy, double name_adequacy);

}  // namespace abbe::diagnose
