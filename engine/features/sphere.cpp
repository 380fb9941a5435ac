#include "engine/features/feature.hpp"
#include "engine/features/lane_fit.hpp"
#include "engine/features/minimax_fit.hpp"
#include "engine/features/nominal.hpp"
#include "engine/features/nominal_normal.hpp"
#include "engine/features/pattern.hpp"
#include "engine/features/points_fit.hpp"

namespace abbe {
namespace {

Outcome<Element> nominal_sphere(const Arguments& arguments) {
  const Outcome<double> size = radius(arguments, "diam");
  if (!size) return Outcome<Element>::failed(size.failure);
  Element e{.point = location(arguments), .size = size.value};
  if (!arguments.has("i")) return {e};
  const Outcome<Vec3> pole = direction(arguments);
  if (!pole) return Outcome<Element>::failed(pole.failure);
  e.direction = pole.value;
  return {e};
}

/// The pole, the others by turns on the circles at 0 and 45 degrees. Without a vector the pole lies towards z, inside
/// towards -z.
Outcome<PatternTouch> touch_sphere(const Element& e, bool inner, int k, int n) {
  Vec3 out = inner ? -e.direction : e.direction;
  if (k > 0) {
    const int circles = n < 9 ? 1 : 2, circle = (k - 1) % circles, on_this = (n - 1 - circle + circles - 1) / circles;
    const double angle = 2 * kPi * ((k - 1) / circles + 0.5 * circle) / on_this, rise = circle * kPi / 4;
    out = std::cos(rise) * Across(e.direction).at(angle) + std::sin(rise) * out;
  }
  return {{e.point + e.size * out, out}};
}

Outcome<Vec3> sphere_normal(const Element& e, const Vec3& point) { return away_along(point - e.point); }

FeatArguments written_sphere(const Element& e) { return {"CART", e.point, 2 * e.size}; }

}  // namespace

extern const FeatureKind sphere_kind{
    .shape = Shape::sphere,
    .word = "SPHERE",
    .signature = "side:INNER|OUTER," ABBE_LOCATION ",diam:length[," ABBE_DIRECTION "]",
    .help = "a sphere: centre and diameter; optionally a vector from the centre to the pole, (0, 0, 1) without",
    .example = "F(S1)=FEAT/SPHERE,OUTER,CART,100,100,50,25",
    .source = "ISO 22093:2011, FEAT/SPHERE; Forbes, NPL DITC 140/89",
    .nominal = nominal_sphere,
    .written = written_sphere,
    .normal = sphere_normal,
    .pattern =
        {.help =
             "one at the pole (inside opposite to it), the others evenly round the equator; from 9 touches on also at 45 degrees",
         .touch = touch_sphere},
    .minimum_points = 4,
    .fit_lanes = fit_lanes_of<SphereProfile>,
    .refit = refit_by<SphereProfile>,
    .fit_points = fit_points_of<SphereProfile, sphere_starts>,
    .fit_names = {.element = "sphere", .point = "center", .size = "radius"},
};

}  // namespace abbe
