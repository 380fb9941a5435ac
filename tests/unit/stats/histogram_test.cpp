#include "engine/stats/histogram.hpp"

#include <doctest/doctest.h>

#include <numeric>

#include "draws.hpp"

using namespace abbe;
using namespace abbe::test;

TEST_CASE("a histogram counts every value once") {
  const std::vector<double> y{1, 2, 3, 4, 5, 6, 7, 8};
  const Histogram h = histogram(y);
  CHECK(h.low == 1);
  CHECK(h.high == 8);
  CHECK(h.counts == std::vector<int>{4, 4});  // 2 iqr n^(-1/3) = 2 (7 - 3) / 2 = 4, for an extent of 7
}

TEST_CASE("bins become narrower with the cube root of the sample") {
  std::vector<double> few, many;
  for (int k = 0; k < 64; ++k) few.push_back(k / 63.0);
  for (int k = 0; k < 4096; ++k) many.push_back(k / 4095.0);
  CHECK(histogram(few).counts.size() == 4);    // width 2 / 2 / 4
  CHECK(histogram(many).counts.size() == 16);  // width 2 / 2 / 16
  const Histogram h = histogram(many);
  CHECK(std::accumulate(h.counts.begin(), h.counts.end(), 0) == 4096);
}

TEST_CASE("a histogram of one value, and of far tails") {
  CHECK(histogram(std::vector<double>{3, 3, 3}).counts == std::vector<int>{3});
  CHECK(histogram(std::vector<double>{3}).counts == std::vector<int>{1});
  std::vector<double> tails(1000, 0.0);
  tails.back() = 1e6;
  const Histogram h = histogram(tails);
  CHECK(h.counts.size() == 40);
  CHECK(h.counts.front() == 999);
  CHECK(h.counts.back() == 1);
}
