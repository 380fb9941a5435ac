// A sum of the same few vectors on many lanes, each with a weight per lane: what is linear in the
// properties of a machine needs its vectors only once for all machines, and then this.
//
// Terms are added one by one in their order, so a lane's result does not depend on the other lanes.
#pragma once

#include <span>

#include "engine/math/vec.hpp"

namespace abbe {

struct WeightedVector {
  Vec3 vector;
  const double* weight = nullptr;  ///< by lane
};

/// (x, y, z)[i] += sum over the terms of weight[i] * vector, for i = 0..n-1.
void add_weighted(int n, std::span<const WeightedVector> terms, double* x, double* y, double* z);

}  // namespace abbe
