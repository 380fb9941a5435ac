#include "engine/diagnose/model/products.hpp"

#include <doctest/doctest.h>

#include <array>

#include "tests/unit/diagnose/random_model.hpp"

namespace abbe::diagnose {

TEST_CASE("each element of a product is the sum of its terms in their order") {
  // Sizes around those of tiles, of columns that are made together, of terms that are added at once, and of few columns.
  for (const auto& [rows, terms, columns] : {std::array{1, 1, 1},
                                             {5, 3, 2},
                                             {7, 4, 6},
                                             {16, 9, 130},
                                             {150, 31, 97},
                                             {6, 40, 90},
                                             {90, 40, 6},
                                             {7, 40, 7},
                                             {2, 0, 3},
                                             {0, 4, 2},
                                             {4, 3, 0},
                                             {17, 600, 7}}) {
    const Matrix a = random_matrix(rows, terms, 1'000'000), b = random_matrix(terms, columns, 2'000'000);
    Matrix sums = Matrix::Zero(rows, columns);
    for (int k = 0; k < terms; ++k)
      for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) sums(i, j) += a(i, k) * b(k, j);
    CHECK(product(a, b) == sums);
    for (int width = 2; width <= vector_width(); width *= 2) CHECK(product(a, b, width) == sums);
    CHECK(transposed_product(a.transpose(), b) == sums);
  }
}

}  // namespace abbe::diagnose
