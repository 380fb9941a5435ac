// OTHER, of recorded values: what the catalogue does not have. A characteristic that strays by itself, a reference that does
// in all places, what differs between runs, single values that stray, and a machine with larger errors than specified.
#pragma once

#include <optional>
#include <string>

#include "engine/diagnose/values/value_case.hpp"

namespace abbe::diagnose {

/// The shape of the pattern that one characteristic strays by itself, in all its repeats alike.
inline constexpr const char* kOneCharacteristic = "one characteristic";
/// That one does of one reference, and of one artefact where rows say which, alike in all places where it was measured.
inline constexpr const char* kOneReference = "one reference";
/// That the values of one run scatter, each by itself.
inline constexpr const char* kScatterOfRun = "scatter of one run";

/// Whether a pattern says where values stray, so that no name of the catalogue that acts elsewhere too is near it.
bool is_located(const Explanation&);

/// To the explanations of the case, whose judges are there. Sets the priors of all of them.
void add_value_patterns(ValueCase&);

/// Whether a pattern is over runs: all lengths of one differ from those of the others, or change from run to run; all by the
/// same, or each in proportion to itself; or those of one run scatter.
bool is_over_runs(const Explanation&);

/// A pattern over runs, and what it predicts of each value, um or urad, in words: "the values of run 3 stray from those of the
/// other runs, all by +3.0 um"; with what to look at.
struct InWords {
  std::string what, otherwise;
  std::optional<int> run;  ///< that differs from the others
};
InWords over_runs(const ValueCase&, const Explanation&, const Variant&, const Vector& predicted);

}  // namespace abbe::diagnose
