// How far a name that may be wrong is believed.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "engine/diagnose/diagnosis.hpp"
#include "engine/effects/effect.hpp"

namespace abbe::diagnose {

/// Below this a name is told as what it looks like, not as what it is.
inline constexpr double kTold = 0.9;
/// The most that is believed of a name that is doubted. A name is doubted
/// - beside something that has none, a pattern or more than chance leaves: whatever made that may have made the rest too;
/// - beside errors of the machine that are twice those of its specification, or more: likewise;
/// - whose size differs between touches more than chance allows (one_size.hpp);
/// - on a covariate that was not logged or did not change: other functions of it would look the same;
/// - where touches are of several styli or orientations that were not logged;
/// - where it is smaller than the steps to which positions are rounded;
/// - of the period of a scale, where touches of the same direction are at the same phase;
/// - of an effect that has no law but a spread: it fits whatever differs so freely;
/// - where it does not predict touches better that it was not fitted to;
/// - that is new within a setup, or gone, although it belongs to the part;
/// - of several sizes none of which is surely other than 0: they stand in for something else;
/// - with a size outside the catalogue's range: rather the name is wrong than the size;
/// - of scatter, where no touch was repeated or repeats agree in it: it may be a pattern too fine for the recording.
inline constexpr double kDoubted = 0.5;
inline double believed(double probability, bool doubted) {
  return doubted ? std::min(probability, kDoubted) : probability;
}

/// Whether held-out touches are predicted better by more than the standard error of the gain, and lie closer. A score may
/// gain because a model is less sure of itself.
bool predicts_better(const std::optional<Improvement>&);

/// Whether every size is inside the catalogue's range.
bool all_plausible(const std::vector<DiagnosedParameter>&);

/// Whether it has several sizes and the interval of each holds 0.
bool none_is_sure(const Effect&, const std::vector<DiagnosedParameter>&);

}  // namespace abbe::diagnose
