#include "engine/tolerances/sections.hpp"

#include <algorithm>
#include <numeric>

namespace abbe {

std::vector<std::vector<std::size_t>> sections(std::span<const double> heights_mm) {
  constexpr double kSame_mm = 0.1;
  std::vector<std::size_t> order(heights_mm.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return heights_mm[a] < heights_mm[b]; });
  std::vector<std::vector<std::size_t>> out;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k == 0 || heights_mm[order[k]] - heights_mm[order[k - 1]] > kSame_mm) out.emplace_back();
    out.back().push_back(order[k]);
  }
  return out;
}

}  // namespace abbe
