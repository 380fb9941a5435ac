// What explains a mismatch: names of the catalogue, and patterns without one.
#pragma once

#include <set>

#include "engine/diagnose/case.hpp"
#include "engine/diagnose/findings/finding.hpp"

namespace abbe::diagnose {

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

/// What machine and noise are beside all that was found, and whether the machine is rougher than its specification's
/// functions: a mismatch may hide that, as such functions its errors would have to be large.
void fit_beside_findings(Case&, SearchResult&);

/// The signatures of findings; of all that was found, a pattern without a name too.
std::vector<const Matrix*> signatures_of(const Case&, const std::vector<Finding>&);
std::vector<const Matrix*> signatures_of(const Case&, const SearchResult&);

}  // namespace abbe::diagnose
