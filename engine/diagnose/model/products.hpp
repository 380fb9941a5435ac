// Products of large matrices, compiled for every level of the processor. Each element is the sum of its terms in their order,
// so that no level changes a bit of it.
#pragma once

#include "engine/diagnose/model/decompositions.hpp"
#include "engine/lanes/vectors.hpp"

namespace abbe::diagnose {

/// a b. `width`: of the vectors in which it is made, at most that of the processor (lanes/vectors.hpp).
Matrix product(const Matrix& a, const Matrix& b, int width = vector_width());
/// a' b.
Matrix transposed_product(const Matrix& a, const Matrix& b);

}  // namespace abbe::diagnose
