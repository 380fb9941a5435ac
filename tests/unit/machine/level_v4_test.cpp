// The geometry kernel for x86-64-v4 alone. Standard headers come first: they keep the level of the
// build.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#pragma GCC target("arch=x86-64-v4")
#define ABBE_ONE_LEVEL
#define abbe abbe_v4
#include "engine/machine/geometry.cpp"
#include "engine/machine/geometry_block.cpp"
#include "tests/unit/machine/level_sample.hpp"
std::vector<double> level_sample_v4() { return abbe::level_sample(); }
#endif
