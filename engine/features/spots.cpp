// EDGEPT and GSURF: features whose touches are the result. Both are the mean of their touches.
#include "engine/features/feature.hpp"
#include "engine/features/nominal.hpp"
#include "engine/features/nominal_normal.hpp"
#include "engine/features/pattern.hpp"

namespace abbe {

extern const FeatureKind point_kind;

namespace {

Outcome<Element> edge_point(const Arguments& arguments) {
  const Outcome<Vec3> along = direction(arguments);
  if (!along) return Outcome<Element>::failed(along.failure);
  const Vec3 surface{arguments.number("is"), arguments.number("js"), arguments.number("ks")};
  if (!(norm(surface) > 0)) return Outcome<Element>::failed("the vector of the surface beside the edge has no length");
  return {{.point = location(arguments), .direction = along.value, .second = unit(surface)}};
}

Outcome<Element> any_surface(const Arguments&) { return {Element{}}; }

void fit_mean(const PointColumns& columns, const Element* start, Element* result, const char** failure) {
  point_kind.fit_lanes(columns, start, result, failure);
  for (int l = 0; l < columns.lanes; ++l) result[l].second = start[l].second;
}

Outcome<Vec3> unknown_normal(const Element&, const Vec3&) {
  return Outcome<Vec3>::failed("a touch on a GSURF needs the vector of the surface in PTMEAS");
}

FeatArguments written_edge_point(const Element& e) { return {"CART", e.point, e.direction, e.second}; }

FeatArguments written_surface(const Element&) { return {}; }

}  // namespace

extern const FeatureKind edge_point_kind{
    .shape = Shape::edge_point,
    .acts_as = Shape::point,
    .word = "EDGEPT",
    .signature = ABBE_LOCATION "," ABBE_DIRECTION ",is:number,js:number,ks:number",
    .help = "a point of an edge: its place, the edge's vector out of the material, the normal of the surface beside it",
    .example = "F(E1)=FEAT/EDGEPT,CART,100,20,0,1,0,0,0,0,1",
    .source = "ISO 22093:2011, FEAT/EDGEPT; the mean of the touches",
    .nominal = edge_point,
    .written = written_edge_point,
    .normal = along_direction,
    .pattern = kAtThePoint,
    .minimum_points = 1,
    .fit_lanes = fit_mean,
};

extern const FeatureKind surface_kind{
    .shape = Shape::surface,
    .acts_as = Shape::point,
    .word = "GSURF",
    .signature = "",
    .help = "a surface of any form; where it lies is said by PTMEAS and judged by PROFS",
    .example = "F(G1)=FEAT/GSURF",
    .source = "ISO 22093:2011, FEAT/GSURF; the mean of the touches",
    .nominal = any_surface,
    .written = written_surface,
    .normal = unknown_normal,
    .minimum_points = 1,
    .fit_lanes = fit_mean,
};

}  // namespace abbe
