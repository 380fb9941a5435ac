// What simpler methods say of the same recording, for comparison.
#pragma once

#include "engine/diagnose/case.hpp"
#include "engine/diagnose/model/evidence.hpp"

namespace abbe::diagnose {

/// `first`: of the recording as it is, nothing named.
OtherMethods other_methods(const Case&, const Evidence& first);

}  // namespace abbe::diagnose
