#include "engine/features/straight_fit.hpp"

#include "engine/features/cloud.hpp"
#include "engine/features/lane_block.hpp"
#include "engine/features/solve.hpp"
#include "engine/features/spread.hpp"

namespace abbe {
namespace {

class StraightFit {
 public:
  StraightFit(Shape shape, const PointColumns& columns, int first, const Element* start, Element* result,
              const char** failure)
      : shape_(shape), start_(start + first), result_(result + first), failure_(failure + first) {
    block_.columns = &columns;
    block_.first = first;
    block_.lanes = std::min(kBlockLanes, columns.lanes - first);
  }

  void run() {
    centre_block(block_);
    for (int l = 0; l < block_.lanes; ++l) {
      Element centred = start_[l];
      centred.point = block_.origin_of(l);
      surface_[l] = placed(shape_, centred, block_.origin_of(l));
      frames_.set(l, surface_[l]);
    }
    sum_products();
    for (int l = 0; l < block_.lanes; ++l) {
      failure_[l] = solve(l);
      frames_.set(l, surface_[l]);
    }
    sum_ranges();
    for (int l = 0; l < block_.lanes; ++l)
      if (!failure_[l]) report(l);
  }

 private:
  /// f(lane, qx, qy, qz) for every touch, coordinates in the frame of the lane.
  template <class F>
  void for_touches(F f) {
    for (int t = 0; t < block_.columns->points; ++t) {
      const double *x = block_.coordinate(t, 0), *y = block_.coordinate(t, 1), *z = block_.coordinate(t, 2);
      for_lanes(block_.lanes, [this, x, y, z, f](int l) {
        double qx, qy, qz;
        frames_.coordinates(block_, x, y, z, l, qx, qy, qz);
        f(l, qx, qy, qz);
      });
    }
  }

  void sum_products() {
    for_touches([this](int l, double x, double y, double z) {
      products_[0][l] += x * x;
      products_[1][l] += x * y;
      products_[2][l] += y * y;
      products_[3][l] += x * z;
      products_[4][l] += y * z;
      products_[5][l] += z * z;
    });
  }

  /// Turns the frame of the lane to its own line or plane; the reason why not, else nullptr.
  const char* solve(int l) {
    double m[3][3];
    for (int i = 0, k = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j) m[i][j] = m[j][i] = products_[k++][l];
    if (!std::isfinite(m[0][0] + m[1][1] + m[2][2])) return reason_of("not_finite");
    const Spread<double> spread = spread_of(m, block_.columns->points);
    double largest = 0;
    for (int k = 0; k < 3; ++k) largest = std::max(largest, std::fabs(block_.origin[k][l]) + spread.along[0]);
    const double negligible = negligible_spread(largest, spread.along[0]);
    if (spread.along[0] <= negligible) return reason_of("identical_points");
    if (shape_ == Shape::plane && spread.along[1] <= negligible) return reason_of("collinear_points");
    const double(&d)[3] = spread.direction[shape_ == Shape::plane ? 2 : 0];
    const double sense = d[2] < 0 ? -1 : 1;  // the frame's z is the nominal direction
    double z[3];
    for (int k = 0; k < 3; ++k)
      z[k] = sense * (d[0] * surface_[l].axes[0][k] + d[1] * surface_[l].axes[1][k] + d[2] * surface_[l].axes[2][k]);
    point_axis(surface_[l], z);
    return nullptr;
  }

  void sum_ranges() {
    LaneRanges& r = ranges_;
    const bool plane = shape_ == Shape::plane;
    for_touches([&r, plane](int l, double x, double y, double z) {
      const double d = plane ? z : std::sqrt(x * x + y * y);
      r.low[l] = d < r.low[l] ? d : r.low[l];
      r.high[l] = d > r.high[l] ? d : r.high[l];
      const double h = plane ? std::sqrt(x * x + y * y) : z;
      r.begin[l] = h < r.begin[l] ? h : r.begin[l];
      r.end[l] = h > r.end[l] ? h : r.end[l];
    });
  }

  void report(int l) {
    Element& e = result_[l] = Element{};
    e.point = block_.origin_of(l);
    e.direction = {surface_[l].axes[2][0], surface_[l].axes[2][1], surface_[l].axes[2][2]};
    e.high = ranges_.high[l];
    e.low = shape_ == Shape::plane ? ranges_.low[l] : -ranges_.high[l];
    e.begin = shape_ == Shape::line ? ranges_.begin[l] : -ranges_.end[l];
    e.end = ranges_.end[l];
  }

  Shape shape_;
  const Element* start_;
  Element* result_;
  const char** failure_;
  LaneBlock block_;
  LaneFrames frames_;
  LaneRanges ranges_;
  alignas(64) double products_[6][kBlockLanes] = {};
  Placed<double> surface_[kBlockLanes];
};

void fit_straight(Shape shape, const PointColumns& columns, const Element* start, Element* result,
                  const char** failure) {
  for (int first = 0; first < columns.lanes; first += kBlockLanes)
    StraightFit(shape, columns, first, start, result, failure).run();
}

FitSolution fit_straight(Shape shape, const Cloud& cloud) {
  FitSolution solution;
  solution.element.point = cloud.centre();
  const Extended(&along)[3] = cloud.spread.direction[shape == Shape::line ? 0 : 2];
  solution.element.direction = {double(along[0]), double(along[1]), double(along[2])};
  CloudRanges ranges;
  for (const auto& p : cloud.exact) {
    const Extended h = p[0] * along[0] + p[1] * along[1] + p[2] * along[2];
    const Extended x = p[0] - h * along[0], y = p[1] - h * along[1], z = p[2] - h * along[2];
    const Extended across = std::sqrt(x * x + y * y + z * z);
    shape == Shape::line ? ranges.add(across, h) : ranges.add(h, across);
  }
  if (shape == Shape::line) ranges.low = -ranges.high;
  ranges.report(solution, cloud.exact.size());
  solution.element.begin = double(shape == Shape::line ? ranges.begin : -ranges.end);
  solution.element.end = double(ranges.end);
  return solution;
}

}  // namespace

void fit_line_lanes(const PointColumns& columns, const Element* start, Element* result, const char** failure) {
  fit_straight(Shape::line, columns, start, result, failure);
}

void fit_plane_lanes(const PointColumns& columns, const Element* start, Element* result, const char** failure) {
  fit_straight(Shape::plane, columns, start, result, failure);
}

FitSolution fit_line_points(const FitProblem&, Cloud cloud, const Element*) { return fit_straight(Shape::line, cloud); }

FitSolution fit_plane_points(const FitProblem&, Cloud cloud, const Element*) {
  return fit_straight(Shape::plane, cloud);
}

}  // namespace abbe
