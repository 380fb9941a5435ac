// What each of several findings does to the touches, all of them fitted together.
#pragma once

#include <vector>

#include "engine/diagnose/case.hpp"

namespace abbe::diagnose {

/// By signature: um by row, beside what is unknown of the part. By least squares.
std::vector<Vector> displacements(const Case&, const std::vector<const Matrix*>& signatures);

/// Whether one of these moves touches by several times as much as all together: what is left of two faults that nearly cancel
/// each other may as well be one small fault of another kind.
bool nearly_cancelled(const std::vector<Vector>& displacements, std::size_t which);

}  // namespace abbe::diagnose
