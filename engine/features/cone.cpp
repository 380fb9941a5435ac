#include "engine/features/feature.hpp"
#include "engine/features/lane_fit.hpp"
#include "engine/features/minimax_fit.hpp"
#include "engine/features/nominal.hpp"
#include "engine/features/nominal_normal.hpp"
#include "engine/features/points_fit.hpp"
#include "engine/features/shape_traits.hpp"
#include "engine/math/units.hpp"

namespace abbe {
namespace {

// The point is the apex, where the radius is zero; the fit moves it to the touches.
Outcome<Element> nominal_cone(const Arguments& arguments) {
  const Outcome<Vec3> along = direction(arguments);
  if (!along) return Outcome<Element>::failed(along.failure);
  const double half_angle = arguments.number("angle") / 2;
  if (!(half_angle > 0 && half_angle < kPi / 2))
    return Outcome<Element>::failed("the full angle of a cone must be more than 0 and less than 180 degrees");
  return {{.point = location(arguments), .direction = along.value, .angle = half_angle}};
}

Outcome<Vec3> cone_normal(const Element& e, const Vec3& point) {
  const Outcome<Vec3> out = away_from_axis(e, point);
  return out ? Outcome<Vec3>{std::cos(e.angle) * out.value - std::sin(e.angle) * e.direction} : out;
}

FeatArguments written_cone(const Element& e) { return {"CART", apex(e), e.direction, in_degrees(2 * e.angle)}; }

}  // namespace

extern const FeatureKind cone_kind{
    .shape = Shape::cone,
    .word = "CONE",
    .signature = "side:INNER|OUTER," ABBE_LOCATION "," ABBE_DIRECTION ",angle:angle",
    .help = "a cone: apex, direction of the axis to the open side, full angle",
    .example = "F(CO1)=FEAT/CONE,INNER,CART,0,0,-40,0,0,1,60",
    .source = "ISO 22093:2011, FEAT/CONE; Forbes, NPL DITC 140/89",
    .nominal = nominal_cone,
    .written = written_cone,
    .normal = cone_normal,
    .minimum_points = 6,
    .fit_lanes = fit_lanes_of<ConeProfile>,
    .refit = refit_by<ConeProfile>,
    .fit_points = fit_points_of<ConeProfile, cone_starts>,
    .fit_names = {.element = "cone",
                  .point = "point",
                  .direction = "axis",
                  .size = "radius",
                  .half_angle = "half_angle_deg",
                  .apex = "apex"},
};

}  // namespace abbe
