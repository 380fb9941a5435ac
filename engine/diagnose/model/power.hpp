// The power of the search: from what size on it sees something, with all that it averages over. Machines in order
// are simulated, and what is to be seen is added to each. What their errors could be instead, larger than the
// specification says, rougher or more uneven, makes it harder to see than its signal-to-noise ratio says.
#pragma once

#include <vector>

#include "engine/diagnose/model/evidence.hpp"

namespace abbe::diagnose {

class Power {
 public:
  /// `of`: outlives it. `machines`: whose recordings are simulated in order, at its level.
  Power(const EvidenceSearch& of, const EvidenceSearch& machines, std::uint64_t seed, int threads);

  /// How many times a shift, um by row, must be there to be detected in 80 % of recordings; infinite beyond `most`.
  /// Several columns: a shift that each recording draws anew. `explanation`: which it is; `share`: what it has of the
  /// belief in all explanations when it is there.
  double detected_from(const Matrix& shift_um, int explanation, double share, double most) const;

 private:
  const EvidenceSearch& search_;
  std::uint64_t seed_;
  double alarm_ = 0;                      ///< the statistic from which on there is one
  std::vector<Ensemble::Seen> in_order_;  ///< of some recordings
};

}  // namespace abbe::diagnose
