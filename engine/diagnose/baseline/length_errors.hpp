// What ISO 10360-2 limits, seen in a recording: lengths between touches of calibrated surfaces that face each
// other or the same way. They do not depend on where the part stood, and a machine that has passed its
// acceptance test does not get them wrong by more than its MPE.
#pragma once

#include <optional>
#include <vector>

#include "engine/diagnose/diagnosis.hpp"
#include "engine/diagnose/model/linear.hpp"
#include "engine/machine/machine.hpp"
#include "engine/run/recorded/touch.hpp"

namespace abbe::diagnose {

/// The residuals of a recording without what the placement of its setups makes of them, um.
Vector without_placement(const LinearModel&);

/// The worst length, as a share of its MPE, but for the two that are worse: one touch of dirt spoils several.
/// Lengths of one setup, run and qualified tip, whose ends are touched along them. Nothing where there are no
/// such lengths. `residuals_um`: without_placement(), for normals are never quite along a length. `left_out`, by touch: outliers;
/// none where they are not known yet.
std::optional<LengthError> worst_length(const RecordedTouches&, const Vector& residuals_um, const Specification&,
                                        const std::vector<char>& left_out = {});

/// That length, where it is worse than what any machine of this specification makes of it, elsewhere in its
/// volume and with other styli than in the acceptance test: by half as much again as its MPE, and what two
/// touches scatter by.
std::optional<LengthError> beyond_specification(const std::optional<LengthError>& worst, const Machine&);

/// Of a recording with such a length: larger errors of the machine than those of its specification are no explanation.
void hold_to_specification(LinearModel&);

/// By how much the touches deviate beside their noise, and machines of the specification on average, um rms; without
/// what the placement of the setups makes of it. `noise_um`: of the touches, as it was found.
struct Deviations {
  double recorded_um = 0, specified_um = 0;
};
Deviations deviations(const LinearModel&, double noise_um);

}  // namespace abbe::diagnose
