// Touches that no row says the stylus of, on surfaces that one stylus cannot have reached.
#pragma once

#include <string>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/math/vec.hpp"
#include "engine/recording/recording.hpp"

namespace abbe::diagnose {

/// Whether more than one stylus or orientation must have touched, and no row says which (W0725).
bool styli_unlogged(const Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// Of the directions in space, about 15 degrees apart, the best: how far along it all normals point at least, from -1 to 1.
double least_along_the_best(const std::vector<Vec3>& normals);

}  // namespace abbe::diagnose
