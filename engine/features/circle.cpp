#include "engine/features/feature.hpp"
#include "engine/features/lane_fit.hpp"
#include "engine/features/minimax_fit.hpp"
#include "engine/features/nominal.hpp"
#include "engine/features/nominal_normal.hpp"
#include "engine/features/pattern.hpp"

namespace abbe {
namespace {

Outcome<Element> nominal_circle(const Arguments& arguments) {
  const Outcome<Vec3> along = direction(arguments);
  if (!along) return Outcome<Element>::failed(along.failure);
  const Outcome<double> size = radius(arguments, "diam");
  if (!size) return Outcome<Element>::failed(size.failure);
  return {{.point = location(arguments), .direction = along.value, .size = size.value}};
}

Outcome<PatternTouch> touch_circle(const Element& e, bool, int k, int n) {
  const Vec3 out = Across(e.direction).at(2 * kPi * k / n);
  return {{e.point + e.size * out, out}};
}

FeatArguments written_circle(const Element& e) { return {"CART", e.point, e.direction, 2 * e.size}; }

}  // namespace

extern const FeatureKind circle_kind{
    .shape = Shape::circle,
    .word = "CIRCLE",
    .signature = "side:INNER|OUTER," ABBE_LOCATION "," ABBE_DIRECTION ",diam:length",
    .help = "a circle: centre, normal of its plane, diameter",
    .example = "F(C1)=FEAT/CIRCLE,INNER,CART,50,50,0,0,0,1,20",
    .source = "ISO 22093:2011, FEAT/CIRCLE; radial distances in the plane of the nominal normal",
    .minimum_points = 3,
    .nominal = nominal_circle,
    .written = written_circle,
    .fit_lanes = fit_lanes_of<CircleProfile>,
    .refit = refit_by<CircleProfile>,
    .normal = away_from_axis,
    .pattern = {.help = "evenly round, the first in the direction of x", .touch = touch_circle},
    .spread = 2,
    .fit_names = {.element = "circle", .point = "center", .direction = "normal", .size = "radius"},
};

}  // namespace abbe
