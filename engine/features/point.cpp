#include <algorithm>

#include "engine/features/cloud.hpp"
#include "engine/features/feature.hpp"
#include "engine/features/lane_block.hpp"
#include "engine/features/nominal.hpp"
#include "engine/features/nominal_normal.hpp"
#include "engine/features/pattern.hpp"
#include "engine/features/solve.hpp"

namespace abbe {
namespace {

/// The mean of the touches; the direction stays that of the nominal.
void fit_point_lanes(const PointColumns& columns, const Element* start, Element* result, const char** failure) {
  for (int first = 0; first < columns.lanes; first += kBlockLanes) {
    LaneBlock block;
    block.columns = &columns;
    block.first = first;
    block.lanes = std::min(kBlockLanes, columns.lanes - first);
    centre_block(block);
    for (int l = 0; l < block.lanes; ++l) {
      const bool finite = std::isfinite(block.extent[l]);
      failure[first + l] = finite ? nullptr : reason_of("not_finite");
      if (finite) result[first + l] = {.point = block.origin_of(l), .direction = start[first + l].direction};
    }
  }
}

FitSolution fit_mean_point(const FitProblem&, Cloud cloud, const Element*) {
  FitSolution solution;
  solution.element.point = cloud.centre();
  return solution;
}

}  // namespace

extern const FeatureKind point_kind{
    .shape = Shape::point,
    .word = "POINT",
    .signature = ABBE_LOCATION "," ABBE_DIRECTION,
    .help = "a surface point and the direction out of the material",
    .example = "F(P1)=FEAT/POINT,CART,10,20,0,0,0,1",
    .source = "ISO 22093:2011, FEAT/POINT; the mean of the touches",
    .nominal = located,
    .written = written_location,
    .normal = along_direction,
    .pattern = kAtThePoint,
    .minimum_points = 1,
    .fit_lanes = fit_point_lanes,
    .fit_points = fit_mean_point,
    .spread = 0,
};

}  // namespace abbe
