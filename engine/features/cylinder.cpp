#include "engine/features/feature.hpp"
#include "engine/features/lane_fit.hpp"
#include "engine/features/nominal.hpp"

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

}  // namespace

extern const FeatureKind cylinder_kind{
    .shape = Shape::cylinder,
    .word = "CYLNDR",
    .signature = "side:INNER|OUTER," ABBE_LOCATION "," ABBE_DIRECTION ",diam:length[,length:length]",
    .help = "a cylinder: a point of the axis, its direction, diameter, optional length",
    .example = "F(CY1)=FEAT/CYLNDR,INNER,CART,50,50,0,0,0,1,20,30",
    .source = "ISO 22093:2011, FEAT/CYLNDR; Forbes, NPL DITC 140/89",
    .minimum_points = 5,
    .nominal = nominal_cylinder,
    .fit_lanes = fit_lanes_of<CylinderProfile>,
};

}  // namespace abbe
