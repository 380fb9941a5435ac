// What the tolerance kinds share: how a zone becomes a limit, and the signatures of limits.
//
// A zone of 0 asks for a value and sets no limit: real programs write POS,2D,0.000,RFS to get a
// report.
#pragma once

#include "engine/features/shape_traits.hpp"
#include "engine/tolerances/tolerance.hpp"

namespace abbe {

// Deviations from a nominal value, or the limits themselves.
#define ABBE_LENGTH_LIMITS "( NOMINL,nominal:length,lower:length,upper:length ; LIMIT,lower:length,upper:length )"
#define ABBE_ANGLE_LIMITS "( NOMINL,nominal:angle,lower:angle,upper:angle ; LIMIT,lower:angle,upper:angle )"
// MMC and LMC widen the zone: material.hpp.
#define ABBE_MATERIAL "[ material:MMC|LMC|RFS ]"
// The feature with respect to which another is measured.
#define ABBE_REFERENCE "( reference:feature ; reference:datum )"
#define ABBE_DATUM "datum:datum,[ datum_material:MMC|LMC|RFS ]"

using Elements = std::span<const Element>;
using Shapes = std::span<const Shape>;

inline Outcome<double> no_value(const char* reason) { return Outcome<double>::failed(reason); }

inline double no_deviation(const Arguments&, Shapes, Elements) { return 0; }

/// ToleranceKind::wants_touches of what is evaluated of the touches themselves.
inline bool always(const Arguments&) { return true; }

inline ToleranceLimits zone_limits(const Arguments& arguments, Elements) {
  const double zone = arguments.number("zone");
  return zone != 0 ? ToleranceLimits{{}, zone} : ToleranceLimits{};
}

/// Limits of a value written as ABBE_LENGTH_LIMITS or ABBE_ANGLE_LIMITS.
inline ToleranceLimits written_limits(const Arguments& arguments) {
  const double nominal = arguments.number("nominal", 0);
  return {nominal + arguments.number("lower"), nominal + arguments.number("upper")};
}

/// The same of a value that has no sign: like a zone, it has no lower limit of 0 or less, because no true value lies below
/// it.
inline ToleranceLimits limits_from_0(const Arguments& arguments) {
  ToleranceLimits limits = written_limits(arguments);
  if (limits.lower <= 0) limits.lower.reset();
  return limits;
}

}  // namespace abbe
