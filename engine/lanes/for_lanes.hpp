// One loop over lanes, compiled for several x86-64 levels. A kernel is a plain scalar functor f(i);
// for_lanes runs it for i = 0..n-1 and the compiler vectorises it. Because contraction is off (see
// CMakeLists.txt) every level gives the same bits: one portable program is also a fast one.
//
// `flatten` inlines the functor into each clone however long it is. Called, it would be compiled for
// the baseline only.
//
// Kernels must not call libm: its calls do not vectorise and differ between versions. They use
// lanes/elementary.hpp.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__) && \
    !defined(ABBE_ONE_LEVEL)
#define ABBE_EVERY_LEVEL __attribute__((flatten, target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define ABBE_EVERY_LEVEL
#endif

#if defined(__GNUC__) && !defined(__clang__)
#define ABBE_NO_ALIAS _Pragma("GCC ivdep")
#else
#define ABBE_NO_ALIAS
#endif

namespace abbe {

template <class F>
ABBE_EVERY_LEVEL void for_lanes(int n, F f) {
  ABBE_NO_ALIAS
  for (int i = 0; i < n; ++i) f(i);
}

/// Several loops over lanes that belong together: all of f() is compiled for every level. Each loop says ABBE_NO_ALIAS itself.
template <class F>
ABBE_EVERY_LEVEL void on_lanes(F f) {
  f();
}

}  // namespace abbe
