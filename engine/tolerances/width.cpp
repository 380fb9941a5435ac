// WIDTH: the distance of the two sides of a feature of size: of parallel planes, or of a slot, a
// rectangle or an ellipse across (SHORT, the default) or along (LONG) their long direction. Limits are
// deviations from the nominal width.
#include "engine/tolerances/common.hpp"

namespace abbe {
namespace {

bool is_pair(Shape s) { return s == Shape::parallel_planes || s == Shape::symmetry_plane; }

const char* two_sided(const Arguments& arguments, Shapes s) {
  if (is_pair(s[0])) return arguments.text("across") == "LONG" ? "two planes have one width only" : nullptr;
  return is_outline(s[0]) ? nullptr : "a width is of parallel planes, slots, rectangles and ellipses";
}

/// An outline keeps two sizes, a pair of planes one.
double width(const Arguments& arguments, const Element& e) {
  const bool one = e.minor_size == 0 || arguments.text("across") == "LONG";
  return 2 * (one ? e.size : e.minor_size);
}

double nominal_width(const Arguments& arguments, Shapes, Elements nominal) { return width(arguments, nominal[0]); }

ToleranceLimits width_limits(const Arguments& arguments, Elements nominal) {
  const double w = width(arguments, nominal[0]);
  return {w + arguments.number("lower"), w + arguments.number("upper")};
}

Outcome<double> actual_width(const Arguments& arguments, const EvaluationInput& in) {
  return {width(arguments, in.actual[0])};
}

}  // namespace

extern const ToleranceKind width_tolerance{
    .word = "WIDTH",
    .signature = "lower:length,upper:length,[ across:SHORT|LONG ]",
    .help =
        "width of parallel planes, or of a slot, rectangle or ellipse (LONG: its length); deviations from the nominal",
    .example = "T(W1)=TOL/WIDTH,-0.05,0.05",
    .source = "ISO 22093:2011, TOL/WIDTH; least-squares size of ISO 14405-1",
    .unit = Unit::mm,
    .features = 1,
    .applies = two_sided,
    .nominal = nominal_width,
    .limits = width_limits,
    .evaluate = actual_width,
    .size_factor = 1,
};

}  // namespace abbe
