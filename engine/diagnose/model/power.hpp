// The power of the search: from what size on it sees something, with all that it averages over. Machines in order
// are simulated, and what is to be seen is added to each. What their errors could be instead, larger than the
// specification says, rougher or more uneven, makes it harder to see than its signal-to-noise ratio says. And a
// recording in which they seem larger is compared with machines whose errors are: what they can take up, as a
// squareness, must stand out of those.
#pragma once

#include <vector>

#include "engine/diagnose/model/evidence.hpp"

namespace abbe::diagnose {

/// A search that reckons with machines whose errors are so many times larger than those in order: more than once.
struct LargerErrors {
  const EvidenceSearch& search;
  double times;
};

class Power {
 public:
  /// `of`, and the search of `larger`: outlive it. `machines`: whose recordings are simulated, at its level and with larger
  /// errors: so many of each, a multiple of EvidenceSearch::kAtOnce.
  Power(const EvidenceSearch& of, LargerErrors larger, const EvidenceSearch& machines, int recordings,
        std::uint64_t seed, int threads);

  /// How many times a shift, um by row, must be there to be detected in 80 % of recordings; infinite beyond `most`.
  /// Several columns: a shift that each recording draws anew. `explanation`: which it is; `share`: what it has of the
  /// belief in all explanations when it is there.
  double detected_from(const Matrix& shift_um, int explanation, double share, double most) const;

 private:
  /// The statistic from which on a search gives the alarm, among machines so many times larger.
  double alarm_of(const EvidenceSearch&, double times, const EvidenceSearch& machines, int threads) const;

  int recordings_;
  std::uint64_t seed_;
  double alarm_ = 0, alarm_of_larger_ = 0;
  LargerErrors larger_;
  std::vector<Ensemble::Seen> in_order_;  ///< of some recordings of machines in order
  Vector log_scales_;                     ///< that these seem to have
};

}  // namespace abbe::diagnose
