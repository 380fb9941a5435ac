// PROFS, PROFL: profile of a surface or a line. The deviation of a touch is how far the surface lies
// from where the program put it, along the vector of the touch, out of the material positive; the
// limits are lower,upper as on a drawing with an unequally disposed zone.
//
// The value is the width of the zone, placed about the middle of the limits, that just holds all
// touches: 2 max |deviation - middle|, to be compared with upper - lower (ISO 1101:2017 and ISO
// 1660:2017, profile deviation). It says the same as "every touch within lower..upper", in one number
// with one limit.
//
// Without datums the surface is compared where it lies in the current coordinate system: no best fit
// takes place. With datums it is compared in the frame that they establish on each machine. PROFL is
// the same for the touches along a line; which ones they are is up to the program.
#include <algorithm>
#include <cmath>

#include "engine/features/alignment.hpp"
#include "engine/tolerances/common.hpp"

namespace abbe {
namespace {

const char* few_datums(const Arguments& arguments, Shapes) {
  return arguments.features("datum").size() > 3 ? "a profile has at most three datums" : nullptr;
}

ToleranceLimits profile_limits(const Arguments& arguments, Elements) {
  const double zone = arguments.number("upper") - arguments.number("lower");
  return zone > 0 ? ToleranceLimits{{}, zone} : ToleranceLimits{};
}

Outcome<double> profile(const Arguments& arguments, const EvaluationInput& in) {
  if (in.touches.empty())
    return no_value("a profile is evaluated of the touches: the feature must be measured, not constructed");
  Rigid own, meant;
  if (!in.datums.empty()) {
    const Outcome<Rigid> frame = datum_reference_frame(in.datum_shapes, in.datums);
    if (!frame) return no_value(frame.failure);
    const Outcome<Rigid> nominal_frame = datum_reference_frame(in.datum_shapes, in.nominal_datums);
    if (!nominal_frame) return no_value(nominal_frame.failure);
    own = inverse(frame.value), meant = inverse(nominal_frame.value);
  }
  const double middle = 0.5 * (arguments.number("lower") + arguments.number("upper"));
  double farthest = 0;
  for (const TouchedPoint& touch : in.touches) {
    const double deviation = dot(own * touch.actual - meant * touch.nominal, meant.R * touch.normal);
    farthest = std::max(farthest, std::fabs(deviation - middle));
  }
  return {2 * farthest};
}

}  // namespace

extern const ToleranceKind surface_profile_tolerance{
    .word = "PROFS",
    .signature = "lower:length,upper:length,{ " ABBE_DATUM " }",
    .help = "profile of a surface: width of the zone about the nominal that holds the touches, against upper - lower",
    .example = "T(PS)=TOL/PROFS,-0.05,0.05,DAT(A)",
    .source = "ISO 22093:2011, TOL/PROFS; ISO 1101:2017, clause 17; ISO 1660:2017",
    .unit = Unit::mm,
    .features = 1,
    .applies = few_datums,
    .nominal = no_deviation,
    .limits = profile_limits,
    .evaluate = profile,
    .wants_touches = always,
};

extern const ToleranceKind line_profile_tolerance{
    .word = "PROFL",
    .signature = "lower:length,upper:length,{ " ABBE_DATUM " }",
    .help = "profile of a line: as PROFS, of touches along a line",
    .example = "T(PL)=TOL/PROFL,-0.05,0.05",
    .source = "ISO 22093:2011, TOL/PROFL; ISO 1101:2017, clause 17; ISO 1660:2017",
    .unit = Unit::mm,
    .features = 1,
    .applies = few_datums,
    .nominal = no_deviation,
    .limits = profile_limits,
    .evaluate = profile,
    .wants_touches = always,
};

}  // namespace abbe
