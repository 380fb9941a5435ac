// PROFS, PROFL, PROFP: profile of a surface, a line or a point. The deviation of a touch is how far the surface lies
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
// the same for the touches along a line; which ones they are is up to the program. PROFP keeps the sign, which
// tells how to mend a tool: its value is the deviation itself, of several touches their mean, between lower and upper.
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
  return zone != 0 ? ToleranceLimits{{}, zone} : ToleranceLimits{};
}

const char* of_a_point(const Arguments& arguments, Shapes s) {
  return s[0] == Shape::point || s[0] == Shape::edge_point ? few_datums(arguments, s)
                                                           : "it is for points; a surface has PROFS, a line PROFL";
}

ToleranceLimits point_limits(const Arguments& arguments, Elements) {
  const ToleranceLimits limits{arguments.number("lower"), arguments.number("upper")};
  return *limits.lower == 0 && *limits.upper == 0 ? ToleranceLimits{} : limits;
}

/// Of every touch, along its vector, in the frame of the datums.
Outcome<std::vector<double>> deviations(const EvaluationInput& in) {
  if (in.touches.empty())
    return Outcome<std::vector<double>>::failed(
        "a profile is evaluated of the touches: the feature must be measured, not constructed");
  Rigid own, meant;
  if (!in.datums.empty()) {
    const Outcome<Rigid> frame = datum_reference_frame(in.datum_shapes, in.datums);
    if (!frame) return Outcome<std::vector<double>>::failed(frame.failure);
    const Outcome<Rigid> nominal_frame = datum_reference_frame(in.datum_shapes, in.nominal_datums);
    if (!nominal_frame) return Outcome<std::vector<double>>::failed(nominal_frame.failure);
    own = inverse(frame.value), meant = inverse(nominal_frame.value);
  }
  std::vector<double> found;
  for (const TouchedPoint& touch : in.touches)
    found.push_back(dot(own * touch.actual - meant * touch.nominal, meant.R * touch.normal));
  return {found};
}

Outcome<double> profile(const Arguments& arguments, const EvaluationInput& in) {
  const Outcome<std::vector<double>> found = deviations(in);
  if (!found) return no_value(found.failure);
  const double middle = 0.5 * (arguments.number("lower") + arguments.number("upper"));
  double farthest = 0;
  for (const double deviation : found.value) farthest = std::max(farthest, std::fabs(deviation - middle));
  return {2 * farthest};
}

Outcome<double> profile_of_point(const Arguments&, const EvaluationInput& in) {
  const Outcome<std::vector<double>> found = deviations(in);
  if (!found) return no_value(found.failure);
  double sum = 0;
  for (const double deviation : found.value) sum += deviation;
  return {sum / static_cast<double>(found.value.size())};
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

extern const ToleranceKind point_profile_tolerance{
    .word = "PROFP",
    .signature = "lower:length,upper:length,{ " ABBE_DATUM " }",
    .help = "profile of a point: its deviation along its vector, out of the material positive, between lower and upper",
    .example = "T(PP)=TOL/PROFP,-0.05,0.05,DAT(A)",
    .source = "ISO 22093:2011, TOL/PROFP",
    .unit = Unit::mm,
    .features = 1,
    .applies = of_a_point,
    .nominal = no_deviation,
    .limits = point_limits,
    .evaluate = profile_of_point,
    .wants_touches = always,
};

}  // namespace abbe
