// The random kernel compiled for single instruction set levels (level_v*_test.cpp), each in a
// namespace of its own.
#pragma once

#include <cstdint>

#define ABBE_LEVEL(space)                                                                                              \
  namespace space {                                                                                                    \
  void normal_pairs(int n, std::uint64_t seed, const std::uint32_t* machine, std::uint32_t stream, std::uint32_t site, \
                    const std::uint32_t* visit, std::uint32_t draw, double* first, double* second);                    \
  }
ABBE_LEVEL(abbe_v2)
ABBE_LEVEL(abbe_v3)
ABBE_LEVEL(abbe_v4)
#undef ABBE_LEVEL
