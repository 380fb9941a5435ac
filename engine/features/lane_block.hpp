// What all fits over lanes share: the lanes of one block side by side, each with an origin of its own near its points.
//
// A block is small enough that its sums stay in the first cache while the touches stream through. Nothing is
// ever summed across lanes, and for_lanes gives the same bits in its vector and its scalar part, so the
// result of a lane does not depend on how lanes are put into batches.
#pragma once

#include <cmath>

#include "engine/features/feature.hpp"
#include "engine/features/revolution.hpp"
#include "engine/lanes/for_lanes.hpp"

namespace abbe {

inline constexpr int kBlockLanes = 32;

/// Lanes [first, first + lanes) of a PointColumns.
struct LaneBlock {
  const PointColumns* columns = nullptr;
  int first = 0, lanes = 0;
  alignas(64) double origin[3][kBlockLanes] = {};  ///< mean of the points, mm
  alignas(64) double extent[kBlockLanes] = {};     ///< root mean square distance of the points from it, mm

  const double* coordinate(int touch, int k) const {
    return columns->data + (3 * static_cast<std::size_t>(touch) + k) * columns->stride + first;
  }
  Vec3 origin_of(int lane) const { return {origin[0][lane], origin[1][lane], origin[2][lane]}; }
};

/// Fills in origin and extent.
void centre_block(LaneBlock&);

/// The frames of the lanes' surfaces, relative to the origins of the block.
struct LaneFrames {
  alignas(64) double p[3][kBlockLanes] = {};
  alignas(64) double axes[3][3][kBlockLanes] = {};

  void set(int lane, const Placed<double>& s) {
    for (int i = 0; i < 3; ++i) {
      p[i][lane] = s.p[i];
      for (int k = 0; k < 3; ++k) axes[i][k][lane] = s.axes[i][k];
    }
  }
  /// Coordinates of one touch of one lane in the frame of its surface.
  void coordinates(const LaneBlock& b, const double* x, const double* y, const double* z, int lane, double& qx,
                   double& qy, double& qz) const {
    const double wx = (x[lane] - b.origin[0][lane]) - p[0][lane];
    const double wy = (y[lane] - b.origin[1][lane]) - p[1][lane];
    const double wz = (z[lane] - b.origin[2][lane]) - p[2][lane];
    qx = axes[0][0][lane] * wx + axes[0][1][lane] * wy + axes[0][2][lane] * wz;
    qy = axes[1][0][lane] * wx + axes[1][1][lane] * wy + axes[1][2][lane] * wz;
    qz = axes[2][0][lane] * wx + axes[2][1][lane] * wy + axes[2][2][lane] * wz;
  }
};

/// Extremes over the touches of a lane.
struct LaneRanges {
  alignas(64) double low[kBlockLanes], high[kBlockLanes], begin[kBlockLanes], end[kBlockLanes];
  LaneRanges() {
    for (int l = 0; l < kBlockLanes; ++l) low[l] = begin[l] = INFINITY, high[l] = end[l] = -INFINITY;
  }
};

/// The fit of one lane by the careful solver of fit_points, for lanes that the fast iteration cannot settle: first from
/// `start`, then without it. `failure` becomes nullptr or the reason.
void fit_one_lane(Shape shape, const PointColumns&, int lane, const Element& start, Element& result,
                  const char*& failure);

}  // namespace abbe
