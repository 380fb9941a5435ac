#include "engine/diagnose/model/products.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace abbe::diagnose {

namespace {

/// Sums that are kept in registers: of so many columns of the result, so many vectors of rows.
constexpr std::ptrdiff_t kColumns = 6, kVectors = 2;
/// Columns that are made before the next, and terms that are added to them at once: what is used again stays next to the
/// processor.
constexpr std::ptrdiff_t kTogether = 16 * kColumns, kTerms = 256;

/// Some rows of some columns of the result.
struct Tile {
  const double* b[kColumns];
  double* sums[kColumns];
};

/// Adds terms, of which a holds the rows of the first, then of the next.
template <int width>
[[gnu::always_inline]] inline void add_terms(std::ptrdiff_t terms, const double* a, const Tile& tile) {
  using Numbers = typename VectorOf<width>::type;
  Numbers sums[kColumns][kVectors];
  for (std::ptrdiff_t c = 0; c < kColumns; ++c)
    for (std::ptrdiff_t v = 0; v < kVectors; ++v) sums[c][v] = reinterpret_cast<const Numbers*>(tile.sums[c])[v];
  for (std::ptrdiff_t k = 0; k < terms; ++k, a += kVectors * width)
    for (std::ptrdiff_t c = 0; c < kColumns; ++c)
      for (std::ptrdiff_t v = 0; v < kVectors; ++v) sums[c][v] += reinterpret_cast<const Numbers*>(a)[v] * tile.b[c][k];
  for (std::ptrdiff_t c = 0; c < kColumns; ++c)
    for (std::ptrdiff_t v = 0; v < kVectors; ++v) reinterpret_cast<Numbers*>(tile.sums[c])[v] = sums[c][v];
}

/// The rows of each tile one after the other, in each its terms; rows of 0 fill the last.
std::vector<double> by_tile(const Matrix& a, std::ptrdiff_t rows) {
  const std::ptrdiff_t tiles = (a.rows() + rows - 1) / rows;
  std::vector<double> out(static_cast<std::size_t>(tiles * rows * a.cols()));
  for (std::ptrdiff_t k = 0; k < a.cols(); ++k)
    for (std::ptrdiff_t t = 0; t < tiles; ++t)
      std::copy_n(&a(t * rows, k), std::min(rows, a.rows() - t * rows), out.data() + (t * a.cols() + k) * rows);
  return out;
}

/// Of so few columns that to put a in the order of tiles would take longer than the product.
bool is_narrow(const Matrix& b) { return b.cols() <= kColumns; }

Matrix narrow_product(const Matrix& a, const Matrix& b) {
  Matrix out = Matrix::Zero(a.rows(), b.cols());
  for (Eigen::Index k = 0; k < a.cols(); ++k)
    for (Eigen::Index c = 0; c < b.cols(); ++c) out.col(c) += b(k, c) * a.col(k);
  return out;
}

/// Sums of some rows side by side, as each waits for the one before it.
Matrix narrow_transposed_product(const Matrix& a, const Matrix& b) {
  constexpr Eigen::Index kRows = 8;
  Matrix out(a.cols(), b.cols());
  for (Eigen::Index first = 0; first < a.cols(); first += kRows) {
    const double* of[kRows];
    for (Eigen::Index i = 0; i < kRows; ++i) of[i] = a.data() + std::min(first + i, a.cols() - 1) * a.rows();
    for (Eigen::Index c = 0; c < b.cols(); ++c) {
      const double* const with = b.data() + c * b.rows();
      double sums[kRows] = {};
      for (Eigen::Index k = 0; k < a.rows(); ++k)
        for (Eigen::Index i = 0; i < kRows; ++i) sums[i] += of[i][k] * with[k];
      for (Eigen::Index i = 0; i < std::min(kRows, a.cols() - first); ++i) out(first + i, c) = sums[i];
    }
  }
  return out;
}

}  // namespace

Matrix product(const Matrix& a, const Matrix& b, int width) {
  if (is_narrow(b)) return narrow_product(a, b);
  const std::ptrdiff_t n = a.rows(), all = a.cols(), columns = b.cols(), rows = kVectors * width,
                       tiles = (n + rows - 1) / rows;
  const std::vector<double> terms = by_tile(a, rows);
  Matrix out(n, columns), sums(tiles * rows, kTogether);
  for (std::ptrdiff_t begin = 0; begin < columns; begin += kTogether) {
    const std::ptrdiff_t end = std::min(columns, begin + kTogether);
    sums.setZero();
    on_vectors(width, [&](auto constant) {
      for (std::ptrdiff_t first = 0; first < all; first += kTerms)
        for (std::ptrdiff_t t = 0; t < tiles; ++t)
          for (std::ptrdiff_t c = begin; c < end; c += kColumns) {
            Tile tile;
            for (std::ptrdiff_t i = 0; i < kColumns; ++i) {  // beyond the last it is made once more, for nobody
              tile.b[i] = b.data() + std::min(c + i, columns - 1) * all + first;
              tile.sums[i] = sums.data() + (c - begin + i) * tiles * rows + t * rows;
            }
            add_terms<constant>(std::min(kTerms, all - first), terms.data() + (t * all + first) * rows, tile);
          }
    });
    out.middleCols(begin, end - begin) = sums.topLeftCorner(n, end - begin);
  }
  return out;
}

Matrix transposed_product(const Matrix& a, const Matrix& b) {
  if (is_narrow(b)) return narrow_transposed_product(a, b);
  if (is_narrow(a)) return narrow_transposed_product(b, a).transpose();
  return product(a.transpose(), b);
}

}  // namespace abbe::diagnose
