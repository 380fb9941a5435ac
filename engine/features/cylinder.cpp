#include "engine/features/feature.hpp"
#include "engine/features/lane_fit.hpp"
#include "engine/features/minimax_fit.hpp"
#include "engine/features/nominal.hpp"
#include "engine/features/nominal_normal.hpp"
#include "engine/features/pattern.hpp"
#include "engine/features/points_fit.hpp"

namespace abbe {
namespace {

// With a length the point is one end of the axis and the vector leads to the other.
Outcome<Element> nominal_cylinder(const Arguments& arguments) {
  const Outcome<Vec3> along = direction(arguments);
  if (!along) return Outcome<Element>::failed(along.failure);
  const Outcome<double> size = radius(arguments, "diam");
  if (!size) return Outcome<Element>::failed(size.failure);
  const double length = arguments.number("length");
  if (arguments.has("length") && !(length > 0)) return Outcome<Element>::failed("the length must be positive");
  return {{.point = location(arguments), .direction = along.value, .size = size.value, .end = length}};
}

/// Sections at equal distances, two of fewer than 12 touches, else three; every other one turned by a quarter
/// of a step.
Outcome<PatternTouch> touch_cylinder(const Element& e, bool, int k, int n) {
  const int sections = n < 12 ? 2 : 3, section = k % sections, in_section = (n - section + sections - 1) / sections;
  const double low = e.end > e.begin ? e.begin : -kPatternReach_mm,
               length = e.end > e.begin ? e.end - e.begin : 2 * kPatternReach_mm;
  const double height = low + length * (0.1 + 0.8 * section / (sections - 1));
  const Vec3 out = Across(e.direction).at(2 * kPi * (k / sections + 0.25 * (section % 2)) / in_section);
  return {{e.point + height * e.direction + e.size * out, out}};
}

FeatArguments written_cylinder(const Element& e) {
  if (!(e.end > e.begin)) return {"CART", e.point, e.direction, 2 * e.size};
  return {"CART", e.point + e.begin * e.direction, e.direction, 2 * e.size, e.end - e.begin};
}

}  // namespace

extern const FeatureKind cylinder_kind{
    .shape = Shape::cylinder,
    .word = "CYLNDR",
    .signature = "side:INNER|OUTER," ABBE_LOCATION "," ABBE_DIRECTION ",diam:length[,length:length]",
    .help = "a cylinder: a point of the axis, its direction, diameter, optional length",
    .example = "F(CY1)=FEAT/CYLNDR,INNER,CART,50,50,0,0,0,1,20,30",
    .source = "ISO 22093:2011, FEAT/CYLNDR; Forbes, NPL DITC 140/89",
    .nominal = nominal_cylinder,
    .written = written_cylinder,
    .normal = away_from_axis,
    .pattern =
        {.help =
             "two sections, three from 12 touches on, evenly round, every other one turned by a quarter of a step; from 10 % to 90 % of the "
             "length, or of 20 mm about the point",
         .touch = touch_cylinder,
         .minimum = 6},  // five points lie on several cylinders
    .minimum_points = 5,
    .fit_lanes = fit_lanes_of<CylinderProfile>,
    .refit = refit_by<CylinderProfile>,
    .fit_points = fit_points_of<CylinderProfile, cylinder_starts>,
    .fit_names = {.element = "cylinder", .point = "point", .direction = "axis", .size = "radius"},
};

}  // namespace abbe
