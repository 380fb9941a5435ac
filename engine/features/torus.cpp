#include "engine/features/feature.hpp"
#include "engine/features/lane_fit.hpp"
#include "engine/features/nominal.hpp"

namespace abbe {
namespace {

Outcome<Element> nominal_torus(const Arguments& arguments) {
  const Outcome<Vec3> along = direction(arguments);
  if (!along) return Outcome<Element>::failed(along.failure);
  const Outcome<double> major = radius(arguments, "majdia"), minor = radius(arguments, "mindia");
  if (!major) return Outcome<Element>::failed(major.failure);
  if (!minor) return Outcome<Element>::failed(minor.failure);
  return {{.point = location(arguments), .direction = along.value, .size = major.value, .minor_size = minor.value}};
}

}  // namespace

extern const FeatureKind torus_kind{
    .shape = Shape::torus,
    .word = "TORUS",
    .signature = "side:INNER|OUTER," ABBE_LOCATION "," ABBE_DIRECTION ",majdia:length,mindia:length",
    .help = "a torus: centre, axis, diameter of the centre line of the tube, diameter of the tube",
    .example = "F(T1)=FEAT/TORUS,OUTER,CART,0,0,0,0,0,1,80,20",
    .source = "ISO 22093:2011, FEAT/TORUS; distance from the centre line of the tube",
    .minimum_points = 7,
    .nominal = nominal_torus,
    .fit_lanes = fit_lanes_of<TorusProfile>,
};

}  // namespace abbe
