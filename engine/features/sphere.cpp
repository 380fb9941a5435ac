#include "engine/features/feature.hpp"
#include "engine/features/lane_fit.hpp"
#include "engine/features/nominal.hpp"

namespace abbe {
namespace {

Outcome<Element> nominal_sphere(const Arguments& arguments) {
  const Outcome<double> size = radius(arguments, "diam");
  if (!size) return Outcome<Element>::failed(size.failure);
  return {{.point = location(arguments), .size = size.value}};
}

}  // namespace

extern const FeatureKind sphere_kind{
    .shape = Shape::sphere,
    .word = "SPHERE",
    .signature = "side:INNER|OUTER," ABBE_LOCATION
                 ","
                 "diam:length",
    .help = "a sphere: centre and diameter",
    .example = "F(S1)=FEAT/SPHERE,OUTER,CART,100,100,50,25",
    .source = "ISO 22093:2011, FEAT/SPHERE; Forbes, NPL DITC 140/89",
    .minimum_points = 4,
    .nominal = nominal_sphere,
    .fit_lanes = fit_lanes_of<SphereProfile>,
};

}  // namespace abbe
