#include "engine/features/lane_block.hpp"

#include "engine/features/solve.hpp"

namespace abbe {

void centre_block(LaneBlock& b) {
  const int touches = b.columns->points;
  for (int k = 0; k < 3; ++k) {
    double* origin = b.origin[k];
    const double* base = b.coordinate(0, k);
    alignas(64) double sum[kBlockLanes] = {};
    for (int t = 1; t < touches; ++t) {  // differences from the first touch: nothing is lost far from the origin
      const double* x = b.coordinate(t, k);
      for_lanes(b.lanes, [&sum, x, base](int l) { sum[l] += x[l] - base[l]; });
    }
    for (int l = 0; l < b.lanes; ++l) origin[l] = base[l] + sum[l] / touches;
  }
  for (int k = 0; k < 3; ++k) {
    const double* origin = b.origin[k];
    double* sum = b.extent;
    for (int t = 0; t < touches; ++t) {
      const double* x = b.coordinate(t, k);
      for_lanes(b.lanes, [sum, x, origin](int l) { sum[l] += (x[l] - origin[l]) * (x[l] - origin[l]); });
    }
  }
  for (int l = 0; l < b.lanes; ++l) b.extent[l] = std::sqrt(b.extent[l] / touches);
}

void fit_one_lane(Shape shape, const PointColumns& columns, int lane, const Element& start, Element& result,
                  const char*& failure) {
  FitProblem problem{shape, {}, {}};
  for (int t = 0; t < columns.points; ++t) problem.points.push_back(columns.at(t, lane));
  if (shape == Shape::circle) problem.normal = start.direction;
  FitSolution solution = fit_points_from(problem, start);
  if (solution.error) solution = fit_points(problem);
  failure = solution.error ? reason_of(solution.error->code) : nullptr;
  if (solution.error) return;
  result = turned_to(shape, solution.element, start.direction);
}

}  // namespace abbe
