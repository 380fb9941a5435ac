// DIAM, RAD: the diameter 2 r or the radius r of the fitted feature, which is what AVG asks for; limits are deviations
// from the nominal size.
#include "engine/tolerances/common.hpp"

namespace abbe {
namespace {

const char* round(const Arguments&, Shapes shapes) {
  return has_diameter(acts_as(shapes[0])) ? nullptr : "a size tolerance is for circles, cylinders and spheres";
}

template <int Factor>
double nominal_size(const Arguments&, Shapes, Elements nominal) {
  return Factor * nominal[0].size;
}

template <int Factor>
ToleranceLimits size_limits(const Arguments& arguments, Elements nominal) {
  const double size = Factor * nominal[0].size;
  return {size + arguments.number("lower"), size + arguments.number("upper")};
}

template <int Factor>
Outcome<double> size(const Arguments&, const EvaluationInput& in) {
  return {Factor * in.actual[0].size};
}

}  // namespace

extern const ToleranceKind diameter_tolerance{
    .word = "DIAM",
    .signature = "lower:length,upper:length,[ use:AVG ]",
    .help = "diameter of a circle, cylinder or sphere; deviations from the nominal diameter",
    .example = "T(D1)=TOL/DIAM,-0.1,0.1",
    .source = "ISO 22093:2011, TOL/DIAM; least-squares size (GG) of ISO 14405-1",
    .unit = Unit::mm,
    .features = 1,
    .applies = round,
    .nominal = nominal_size<2>,
    .limits = size_limits<2>,
    .evaluate = size<2>,
    .size_factor = 1,
};

extern const ToleranceKind radius_tolerance{
    .word = "RAD",
    .signature = "lower:length,upper:length,[ use:AVG ]",
    .help = "radius of a circle, cylinder or sphere; deviations from the nominal radius",
    .example = "T(R1)=TOL/RAD,-0.05,0.05",
    .source = "ISO 22093:2011, TOL/RAD",
    .unit = Unit::mm,
    .features = 1,
    .applies = round,
    .nominal = nominal_size<1>,
    .limits = size_limits<1>,
    .evaluate = size<1>,
    .size_factor = 2,
};

}  // namespace abbe
