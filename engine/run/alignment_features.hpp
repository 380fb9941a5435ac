// Which features a program builds its coordinate systems from.
//
// An error of such a feature moves everything that is reported afterwards; an error of another one moves only what is
// evaluated of it. The uncertainty budget tells the two apart. A feature counts as soon as a DATSET, TRANS or ROTATE
// names it, or names what was constructed from it, at any number of removes; it may be evaluated as well.
#pragma once

#include <vector>

#include "engine/plan/plan.hpp"

namespace abbe {

/// By FeatureId: true for the features that coordinate systems are built from.
std::vector<char> alignment_features(const plan::Plan&);

}  // namespace abbe
