// Which values a diagnosis tries for the parameters of an effect in which its displacement is not linear: each
// parameter says how it is sought (effects/effect.hpp); what lies within a recording is taken from it here.
#pragma once

#include <vector>

#include "engine/diagnose/model/explanation.hpp"
#include "engine/run/recorded/touch.hpp"

namespace abbe::diagnose {

/// A value of a parameter, the values that it stands for, and how much of the belief in all of them is theirs.
struct TriedValue {
  double value = 0;
  Cell cell;
  double share = 1;
};

/// Each of these variants with each of the values for its next parameter, and a share of its weight.
std::vector<Variant> with_each(const std::vector<Variant>&, const std::vector<TriedValue>&);

/// How a parameter enters the search.
struct ParameterGrid {
  enum class Kind {
    fixed,      ///< one value
    tried,      ///< one after the other
    direction,  ///< the three axes together span every direction: one column for each
    phase,      ///< 0 and 90 degrees together span every phase
  };
  Kind kind = Kind::fixed;
  double fixed = 0;                    ///< the one value
  std::vector<TriedValue> tried = {};  ///< each is a variant
  /// of `tried`: values between these are possible too, and sought where the recording asks for them
  bool between = false;
};

/// No period of a scale is tried that is shorter than the least.
ParameterGrid grid_of(const EffectParameter&, const RecordedTouches&, double least_period_um = 0);

/// A stretch of time in parts with as many gaps between touches (or one more), each with the middle of its middle gap for
/// a value: only in which gap a moment lies can be told, and a pause is one. `ends_s` are the ends of the gaps, ascending;
/// of fewer gaps than parts, each is one.
std::vector<TriedValue> moments_between(const std::vector<double>& ends_s, std::size_t parts);

/// The probing speeds, mm/s, ascending. Those that a control holds only roughly are one.
std::vector<double> speeds_in(const RecordedTouches&);

/// The shortest period that is sought as that of a room's control, in a recording of this duration: ten minutes, as few
/// controls switch more often; in a short recording a fourteenth of it, but not below two minutes, which no frame follows;
/// of more than three days and a half, in which there would be too many to try, one of 500 cycles.
/// What swings quicker is a pattern (patterns/time.cpp).
double quickest_of_a_room_s(double duration_s);

}  // namespace abbe::diagnose
