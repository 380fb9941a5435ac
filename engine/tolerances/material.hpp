// Material conditions: how far MMC and LMC widen a zone (ISO 2692:2021; ASME Y14.5-2018, 5.9 and 7.11).
//
// The value of the tolerance stays what it is without them; the limit grows by the *departure* of the
// actual size from the size at the material condition, so that a hole that is larger than its
// smallest size may be out of place by as much more. Every virtual machine measures its own size, so
// every machine has its own limit, and conformity is judged machine by machine.
//
// The sizes at the condition come from the tolerance of size (DIAM, RAD, WIDTH) that the same
// statement, or an earlier one, evaluates of the feature. The actual size is that of the fit in
// force: GEOALG with MAXINS or MINCIR gives the related actual mating size that the standards mean.
// The departure is held between 0 and the whole tolerance of size: a feature beyond its limits of
// size fails by its size, and earns or loses nothing more here.
//
// On a datum the departure lets the datum frame shift. It is reckoned with only where the shift is a
// pure displacement across the datum's axis (lang/statements/tolerance.cpp says when); then a
// clearance c on the diameter moves the frame by c / 2 to any side, which is worth c on the diameter
// of the zone. The feature is judged by itself: features that must fit at once may not all use the
// same shift.
#pragma once

#include "engine/tolerances/tolerance.hpp"

namespace abbe {

enum class Condition { maximum_material, least_material };

/// The departure of the actual size from the size at the condition, mm across the feature, not
/// negative. `value` and `limits` are those of the tolerance of size `size`; `inner`: the material
/// is outside.
double departure_mm(const ToleranceKind& size, double value, const ToleranceLimits& limits, bool inner, Condition);

}  // namespace abbe
