// Orthogonal least squares of surfaces of revolution over lanes: Gauss-Newton from the nominal, with the
// normal equations (at most 7 x 7) summed for all lanes of a block at once and solved lane by lane.
//
// Precision: every lane works about the mean of its own points and in the frame of its own surface, and the
// system is scaled to unit diagonal. The normal equations square the condition number of the step only; the
// answer is where the gradient vanishes, and its accuracy is that of the distances. Convergence is judged by
// how far a step moves the surface at the points, not by the unknowns: on a short arc the radius and the
// place of the axis change together by far more than the size of the feature, and the surface hardly moves.
// The remaining error is estimated from the contraction of the steps, s kappa / (1 - kappa). A lane is frozen
// when that is below rounding, so that more iterations for its neighbours do not change it.
#pragma once

#include <algorithm>
#include <utility>

#include "engine/features/lane_block.hpp"
#include "engine/math/cholesky.hpp"

namespace abbe {

template <class Profile>
class LaneFit {
 public:
  LaneFit(const PointColumns& columns, int first, const Element* start, Element* result, const char** failure)
      : start_(start + first), result_(result + first), failure_(failure + first) {
    block_.columns = &columns;
    block_.first = first;
    block_.lanes = std::min(kBlockLanes, columns.lanes - first);
  }

  void run() {
    centre_block(block_);
    for (int l = 0; l < block_.lanes; ++l) {
      surface_[l] = placed(Profile::kShape, start_[l], block_.origin_of(l));
      anchor_near<Profile>(surface_[l], kOrigin);
    }
    int open = block_.lanes;
    for (int iteration = 0; iteration < kIterations && open > 0; ++iteration) {
      sum_rows();
      open = 0;
      for (int l = 0; l < block_.lanes; ++l) {
        if (state_[l] == State::open) step(l);
        open += state_[l] == State::open;
      }
    }
    finish();
  }

 private:
  static constexpr int N = kUnknowns<Profile>;
  static constexpr int kSums = (N + 1) * (N + 2) / 2;
  static constexpr int kIterations = 25;
  static constexpr double kOrigin[3] = {0, 0, 0};
  enum class State : char { open, settled, lost };

  /// The symmetric matrix [J d]^T [J d] of every lane, lower triangle by rows.
  void sum_rows() {
    publish();
    for (auto& sum : sums_) std::fill(std::begin(sum), std::end(sum), 0.0);
    for (int t = 0; t < block_.columns->points; ++t) {
      const double *x = block_.coordinate(t, 0), *y = block_.coordinate(t, 1), *z = block_.coordinate(t, 2);
      for_lanes(block_.lanes, [this, x, y, z](int l) {
        double qx, qy, qz, row[N + 1];
        frames_.coordinates(block_, x, y, z, l, qx, qy, qz);
        const double ready[3] = {ready_[0][l], ready_[1][l], ready_[2][l]};
        distance_row<Profile>(qx, qy, qz, ready, row);
        add_products(l, row, std::make_integer_sequence<int, N + 1>{});
      });
    }
  }

  template <int... I>
  void add_products(int l, const double (&row)[N + 1], std::integer_sequence<int, I...>) {
    (add_products_of<I>(l, row, std::make_integer_sequence<int, I + 1>{}), ...);
  }
  template <int I, int... J>
  void add_products_of(int l, const double (&row)[N + 1], std::integer_sequence<int, J...>) {
    ((sums_[I * (I + 1) / 2 + J][l] += row[I] * row[J]), ...);
  }

  /// Makes the surfaces of the lanes visible to the kernels.
  void publish() {
    for (int l = 0; l < block_.lanes; ++l) {
      frames_.set(l, surface_[l]);
      double ready[3] = {};
      Profile::prepare(surface_[l].size, ready);
      for (int k = 0; k < 3; ++k) ready_[k][l] = ready[k];
    }
  }

  void step(int l) {
    SymmetricSystem<double, N> s;
    for (int i = 0, k = 0; i < N; ++i)
      for (int j = 0; j <= i; ++j) s.a[i][j] = sums_[k++][l];
    for (int i = 0; i < N; ++i) s.b[i] = -sums_[N * (N + 1) / 2 + i][l];
    double by[N];
    if (!solve_positive_definite(s, by, kLeastPivot)) {
      state_[l] = State::lost;
      return;
    }
    double squares = 0;  // of the distances by which the step moves the surface at the points: |J by|^2 = by . b
    for (int i = 0; i < N; ++i) squares += by[i] * s.b[i];
    const double size = std::sqrt(std::max(squares, 0.0) / block_.columns->points);
    const double radius = surface_[l].size[0];
    move_by<Profile>(surface_[l], by);
    const bool too_far = !(surface_[l].size[0] > 0.5 * radius);  // the distances are not linear in the radius that far
    anchor_near<Profile>(surface_[l], kOrigin);
    too_far ? void(state_[l] = State::lost) : judge(l, size);
  }

  void judge(int l, double size) {
    const double before = last_step_[l], extent = block_.extent[l];
    last_step_[l] = size;
    if (!(size < extent)) {
      state_[l] = State::lost;
    } else if (size <= 1e-15 * extent || size * size < 1e-14 * extent * (before - size)) {
      state_[l] = State::settled;
    } else if (size >= before && before > 0 && before < 1e-10 * extent) {
      state_[l] = State::settled;  // the steps are rounding noise
    }
  }

  void finish() {
    publish();
    LaneRanges ranges;
    for (int t = 0; t < block_.columns->points; ++t) {
      const double *x = block_.coordinate(t, 0), *y = block_.coordinate(t, 1), *z = block_.coordinate(t, 2);
      for_lanes(block_.lanes, [this, &ranges, x, y, z](int l) {
        double qx, qy, h;
        frames_.coordinates(block_, x, y, z, l, qx, qy, h);
        const double ready[3] = {ready_[0][l], ready_[1][l], ready_[2][l]};
        const double d = Profile::slopes(std::sqrt(qx * qx + qy * qy), h, ready).d;
        ranges.low[l] = d < ranges.low[l] ? d : ranges.low[l];
        ranges.high[l] = d > ranges.high[l] ? d : ranges.high[l];
        ranges.begin[l] = h < ranges.begin[l] ? h : ranges.begin[l];
        ranges.end[l] = h > ranges.end[l] ? h : ranges.end[l];
      });
    }
    for (int l = 0; l < block_.lanes; ++l) {
      if (state_[l] == State::settled && surface_[l].size[0] > 0 && surface_[l].size[Profile::kSizes - 1] != 0)
        report(l, ranges);
      else
        fit_one_lane(Profile::kShape, *block_.columns, block_.first + l, start_[l], result_[l], failure_[l]);
    }
  }

  void report(int l, const LaneRanges& ranges) {
    failure_[l] = nullptr;
    const double origin[3] = {block_.origin[0][l], block_.origin[1][l], block_.origin[2][l]};
    bool turned = false;
    Element& e = result_[l] = element_of(Profile::kShape, surface_[l], origin, &turned);
    e.low = ranges.low[l];
    e.high = ranges.high[l];
    if (Profile::kShape != Shape::cylinder && Profile::kShape != Shape::cone) return;
    e.begin = turned ? -ranges.end[l] : ranges.begin[l];
    e.end = turned ? -ranges.begin[l] : ranges.end[l];
  }

  static constexpr double kLeastPivot = 1e-13;

  const Element* start_;
  Element* result_;
  const char** failure_;
  LaneBlock block_;
  LaneFrames frames_;
  alignas(64) double ready_[3][kBlockLanes] = {};
  alignas(64) double sums_[kSums][kBlockLanes] = {};
  Placed<double> surface_[kBlockLanes];
  double last_step_[kBlockLanes] = {};  ///< 0 before the first
  State state_[kBlockLanes] = {};
};

/// FeatureKind::fit_lanes of a surface of revolution.
template <class Profile>
void fit_lanes_of(const PointColumns& columns, const Element* start, Element* result, const char** failure) {
  for (int first = 0; first < columns.lanes; first += kBlockLanes)
    LaneFit<Profile>(columns, first, start, result, failure).run();
}

}  // namespace abbe
