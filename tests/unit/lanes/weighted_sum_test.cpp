#include "engine/lanes/weighted_sum.hpp"

#include <doctest/doctest.h>

#include <vector>

using namespace abbe;

TEST_CASE("weighted sum: the terms one after the other, to the bit, for any number of terms and lanes") {
  for (int terms = 0; terms < 10; ++terms)
    for (const int n : {1, 3, 8, 13}) {
      std::vector<std::vector<double>> weights;
      std::vector<WeightedVector> sum;
      for (int t = 0; t < terms; ++t) {
        std::vector<double>& w = weights.emplace_back();
        for (int i = 0; i < n; ++i) w.push_back(1.0 / (1 + i + 3 * t));
        sum.push_back({{0.1 * (t + 1), -1.7 / (t + 2), 1.3 * t}, w.data()});
      }
      std::vector<double> x(n, 0.3), y(n, -0.7), z(n, 1.1);
      add_weighted(n, sum, x.data(), y.data(), z.data());
      for (int i = 0; i < n; ++i) {
        Vec3 expected{0.3, -0.7, 1.1};
        for (int t = 0; t < terms; ++t) expected += weights[t][i] * sum[t].vector;
        CHECK(Vec3{x[i], y[i], z[i]} == expected);
      }
    }
}
