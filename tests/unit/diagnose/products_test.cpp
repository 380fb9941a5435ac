#include "engine/diagnose/model/products.hpp"

#include <doctest/doctest.h>

#include <array>

#include "tests/unit/diagnose/random_model.hpp"

namespace abbe::diagnose {

TEST_CASE("each element of a product is the sum of its terms in their order") {
  // Sizes around those of pairs, of four terms at once, and of what stays near the processor.
  for (const auto& [rows, terms, columns] :
       {std::array{1, 1, 1}, {5, 3, 2}, {7, 4, 3}, {3, 9, 130}, {150, 31, 65}, {2, 0, 3}, {0, 4, 2}, {700, 6, 1}}) {
    const Matrix a = random_matrix(rows, terms, 1'000'000), b = random_matrix(terms, columns, 2'000'000);
    Matrix sums = Matrix::Zero(rows, columns);
    for (int k = 0; k < terms; ++k)
      for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) sums(i, j) += a(i, k) * b(k, j);
    CHECK(product(a, b) == sums);
    CHECK(transposed_product(a.transpose(), b) == sums);
  }
}

}  // namespace abbe::diagnose
