// Code that keeps vectors of numbers in registers, compiled for the vectors of several x86-64 levels. A loop of for_lanes.hpp is left to
// the compiler; what must hold many sums at once says how wide they are. Each number is worked on as if it were alone, so
// that no width changes a bit.
#pragma once

#include <type_traits>

namespace abbe {

/// `width` numbers, at any address of doubles.
template <int width>
struct VectorOf {
  using type [[gnu::vector_size(8 * width), gnu::aligned(8), gnu::may_alias]] = double;
};

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)

/// The widest that this processor has: 2, 4 or 8.
inline int vector_width() {
  return __builtin_cpu_supports("x86-64-v4") ? 8 : __builtin_cpu_supports("x86-64-v3") ? 4 : 2;
}

template <class F>
[[gnu::flatten, gnu::target("arch=x86-64-v4")]] void on_vectors_of_8(F f) {
  f(std::integral_constant<int, 8>{});
}

template <class F>
[[gnu::flatten, gnu::target("arch=x86-64-v3")]] void on_vectors_of_4(F f) {
  f(std::integral_constant<int, 4>{});
}

#else

inline int vector_width() { return 2; }

template <class F>
void on_vectors_of_8(F f) {
  f(std::integral_constant<int, 8>{});
}

template <class F>
void on_vectors_of_4(F f) {
  f(std::integral_constant<int, 4>{});
}

#endif

/// f with the width as a constant: 2, 4 or 8, at most vector_width(). All of f is compiled for it.
template <class F>
void on_vectors(int width, F f) {
  if (width == 8)
    on_vectors_of_8(f);
  else if (width == 4)
    on_vectors_of_4(f);
  else
    f(std::integral_constant<int, 2>{});
}

}  // namespace abbe
