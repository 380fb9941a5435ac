// A sudden change in the middle of a feature makes its touches contradict each other: the fewer of them look like dirt.
#pragma once

#include <vector>

#include "engine/diagnose/case.hpp"

namespace abbe::diagnose {

/// By touch: whether it was masked, and lies where one displacement of all touches from some moment on puts it, together
/// with at least one other. A single one may be dirt. Reads `masked`, `hyper` and the baseline of the case.
std::vector<char> put_there_by_a_sudden_change(const Case&);

}  // namespace abbe::diagnose
