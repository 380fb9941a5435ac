#include "engine/diagnose/model/products.hpp"

#include <algorithm>
#include <cstddef>

#include "engine/lanes/for_lanes.hpp"

namespace abbe::diagnose {

namespace {

/// Terms that are added to a column of the result while it is read and written once.
constexpr std::ptrdiff_t kTerms = 4;
/// Numbers of a that stay next to the processor while they are used for all columns: 16 kB.
constexpr std::ptrdiff_t kInCache = 2048;

/// Columns of the result that are made before the next: an even number, a pair at a time.
constexpr std::ptrdiff_t kColumns = 64;

/// Two columns of the result, and of b.
struct Columns {
  const double *b, *next_b;
  double *out, *next_out;
};

/// Adds the terms first to last - 1, whose number is a multiple of `terms`, to n rows of two columns.
template <std::ptrdiff_t terms>
[[gnu::always_inline]] inline void add_terms(std::ptrdiff_t n, const double* a, std::ptrdiff_t first,
                                             std::ptrdiff_t last, const Columns& c) {
  double *const out = c.out, *const next_out = c.next_out;
  for (std::ptrdiff_t k = first; k < last; k += terms) {
    const double* const of_a = a + k * n;
    double b[terms], next_b[terms];  // or they would be read again after each number that is written
    std::copy_n(c.b + k, terms, b);
    std::copy_n(c.next_b + k, terms, next_b);
    ABBE_NO_ALIAS
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      double sum = out[i], next_sum = next_out[i];
      for (std::ptrdiff_t term = 0; term < terms; ++term) {
        sum += of_a[term * n + i] * b[term];
        next_sum += of_a[term * n + i] * next_b[term];
      }
      out[i] = sum, next_out[i] = next_sum;
    }
  }
}

}  // namespace

Matrix product(const Matrix& a, const Matrix& b) {
  const std::ptrdiff_t n = a.rows(), all = a.cols(), columns = b.cols(),
                       together =
                           kTerms * std::max<std::ptrdiff_t>(1, kInCache / kTerms / std::max<std::ptrdiff_t>(n, 1));
  Matrix out = Matrix::Zero(n, columns);
  Vector beside = Vector::Zero(n);  // columns go in pairs
  on_lanes([=, a = a.data(), b = b.data(), out = out.data(), beside = beside.data()] {
    for (std::ptrdiff_t begin = 0; begin < columns; begin += kColumns)
      for (std::ptrdiff_t first = 0; first < all; first += together) {
        const std::ptrdiff_t last = std::min(all, first + together), whole = last - (last - first) % kTerms;
        for (std::ptrdiff_t c = begin; c < std::min(columns, begin + kColumns); c += 2) {
          const bool single = c + 1 == columns;
          const double* const of_b = b + c * all;
          double* const of_out = out + c * n;
          const Columns pair{of_b, single ? of_b : of_b + all, of_out, single ? beside : of_out + n};
          add_terms<kTerms>(n, a, first, whole, pair);
          add_terms<1>(n, a, whole, last, pair);
        }
      }
  });
  return out;
}

Matrix transposed_product(const Matrix& a, const Matrix& b) { return product(a.transpose(), b); }

}  // namespace abbe::diagnose
