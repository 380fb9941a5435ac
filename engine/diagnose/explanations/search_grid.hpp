// Which values a diagnosis tries for the parameters of an effect in which its displacement is not linear: each
// parameter says how it is sought (effects/effect.hpp); what lies within a recording is taken from it here.
#pragma once

#include <vector>

#include "engine/diagnose/explanations/explanation.hpp"

namespace abbe::diagnose {

/// How a parameter enters the search.
struct Search {
  enum class Kind {
    fixed,      ///< one value
    tried,      ///< each of `values` is a variant
    direction,  ///< the three axes together span every direction: one column for each
    phase,      ///< 0 and 90 degrees together span every phase
  };
  Kind kind = Kind::fixed;
  std::vector<double> values;
  /// of `tried`: values between these are possible too, and sought where the recording asks for them
  bool between = false;
};

/// What each value of a list stands for: up to halfway to its neighbours, and as far beyond the ends.
std::vector<Cell> cells_of(const Search&);

Search search_of(const EffectParameter&, const RecordedTouches&);

/// The shortest period that is sought as that of a room's control, in a recording of this duration: ten minutes, as few
/// controls switch more often; in a short recording a fourteenth of it, but not below two minutes, which no frame follows.
/// What swings quicker is a pattern (patterns/time.cpp).
double quickest_of_a_room_s(double duration_s);

}  // namespace abbe::diagnose
