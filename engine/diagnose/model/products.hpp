// Products of large matrices, compiled for every level of the processor. Each element is the sum of its terms in their order,
// so that no level changes a bit of it.
#pragma once

#include "engine/diagnose/model/decompositions.hpp"

namespace abbe::diagnose {

/// a b.
Matrix product(const Matrix& a, const Matrix& b);
/// a' b.
Matrix transposed_product(const Matrix& a, const Matrix& b);

}  // namespace abbe::diagnose
