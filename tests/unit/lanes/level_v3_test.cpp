// The random kernel for x86-64-v3 alone. Standard headers come first: they keep the level of the
// build.
#include <bit>
#include <cmath>
#include <cstdint>
#include <string_view>

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#pragma GCC target("arch=x86-64-v3")
#define ABBE_ONE_LEVEL
#define abbe abbe_v3
#include "engine/lanes/random.cpp"
#endif
